// diatom convert: any readable file to a .diatom document.
#include "cli/commands.h"

#include "core/file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>

namespace diatom::cli {

namespace {

struct ConvertOptions
{
   std::string in, out;
   bool packed = false;
};

/// Opens without a lattice: a document whose lattice is not installed converts all the same.
void convert(Context &context, const ConvertOptions &options)
{
   const auto suffix = std::filesystem::path(options.out).extension().string();
   if (options.out != "-" && suffix != ".diatom") {
      context.fail({ErrorCode::usage,
                    fmt::format("{}: only .diatom documents can be written; for meshes use `diatom export`",
                                options.out)});
      return;
   }
   auto opened = openDesign(options.in, context.job());
   if (!opened) {
      context.fail(opened.error());
      return;
   }
   for (const auto &text : opened->notes)
      context.note(text);
   Status saved;
   if (options.packed) {
      const auto bytes = writeDesign(opened->design, true, context.job());
      saved = bytes ? writeFileAtomic(options.out, *bytes) : Status(bytes.error());
   } else {
      saved = saveDesign(opened->design, options.out, context.job());
   }
   if (!saved)
      context.fail(saved.error());
}

} // namespace

void addConvert(CLI::App &app, Context &context)
{
   auto *command = app.add_subcommand("convert", "Turn any readable file into a .diatom document");
   const auto options = std::make_shared<ConvertOptions>();
   command
       ->add_option("IN", options->in,
                    "a .diatom document or a file of AMOEBA or DMDesign; - reads standard input")
       ->required();
   command->add_option("OUT", options->out, "the .diatom document to write; - writes to standard output")
       ->required();
   command->add_flag("--packed", options->packed, "write the packed form even when small");
   command->callback([&context, options] { convert(context, *options); });
}

} // namespace diatom::cli
