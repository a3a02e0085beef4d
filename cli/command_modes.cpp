// diatom modes: the lowest vibrations of a design about its static balance.
#include "cli/commands.h"
#include "cli/number_checks.h"
#include "cli/run_options.h"
#include "cli/scene_json.h"
#include "core/text.h"
#include "scene/modes.h"
#include "scene/problems.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <optional>

namespace diatom::cli {

namespace {

using Json = nlohmann::ordered_json;

struct ModesOptions
{
   RunOptions run;
   std::optional<double> at;
   int count = 10;
   std::string shapes;
};

const char *kindText(Mode::Kind kind)
{
   switch (kind) {
   case Mode::Kind::vibration:
      return "vibration";
   case Mode::Kind::neutral:
      return "neutral";
   case Mode::Kind::unstable:
      return "unstable";
   }
   return "";
}

/// A row for each cell of each mode.
Status writeShapes(const Modes &found, const std::filesystem::path &file, const Job &job)
{
   AtomicFile out(file);
   out.write("mode,frequency (Hz),i,j,k,x (m),y (m),z (m),rx (rad),ry (rad),rz (rad)\n");
   const auto &indices = found.run->scene().indices();
   for (std::size_t mode = 0; mode < found.modes.size(); ++mode) {
      if (job.cancelled())
         return Error{ErrorCode::cancelled, "cancelled while writing the shapes"};
      const auto shape = found.shape(mode, job);
      if (!shape)
         return shape.error();
      for (std::size_t cell = 0; cell < indices.size(); ++cell) {
         std::string line = fmt::format("{},{},{},{},{}", mode + 1, numberText(found.modes[mode].hertz),
                                        indices[cell].x, indices[cell].y, indices[cell].z);
         for (std::size_t k = 0; k < 6; ++k)
            line += "," + numberText((*shape)[6 * cell + k]);
         out.write(line + "\n");
      }
   }
   return out.commit();
}

Json report(const Modes &found, bool json)
{
   Json object{{"status", "done"},
               {"cells", found.run->scene().cells()},
               {"links", found.run->scene().view().links},
               {"residual", found.residual},
               {"iterations", found.iterations},
               {"wall_s", found.run->wallSeconds()}};
   auto hertz = Json::array(), modes = Json::array();
   for (const Mode &mode : found.modes) {
      if (mode.kind == Mode::Kind::vibration)
         hertz.push_back(mode.hertz);
      modes.push_back(
          {{"kind", kindText(mode.kind)}, {"hertz", mode.hertz}, {"eigenvalue_rad2_s2", mode.eigenvalue}});
   }
   object["hertz"] = std::move(hertz);
   object["modes"] = std::move(modes);
   object["effects"] = effectsReport(found.run->scene().effects(), json);
   return object;
}

/// A body that can move as a whole has neutral modes, which are found and told; how it can move helps to read
/// them.
void noteFreeMotions(const Context::Input &input, Context &context)
{
   const Setup &setup = input.opened.design.setup;
   if (!findSetupProblems(*input.hierarchy, setup).empty())
      return;
   if (const auto bodies = findBodies(*input.hierarchy, context.job()))
      for (const Problem &problem : findUnheldBodies(*input.hierarchy, *bodies, setup, context.job()))
         context.note("warning: " + problem.text);
}

Status findInput(const Context::Input &input, const ModesOptions &options, Context &context)
{
   const Setup &setup = input.opened.design.setup;
   auto scene = Scene::build(*input.hierarchy, setup, context.job(), Analysis::modes);
   if (!scene)
      return scene.error();
   noteFreeMotions(input, context);
   BalanceRequest request;
   request.time = options.at;
   const auto found = findModes(context.catalogue(), *std::move(scene), setup, {}, request, context.job());
   if (!found)
      return found.error();
   if (!options.shapes.empty())
      if (Status kept = writeShapes(*found, options.shapes, context.job()); !kept)
         return kept;
   context.print(report(*found, context.json));
   for (const Mode &mode : found->modes)
      if (mode.kind == Mode::Kind::unstable) {
         context.note("warning: the balance is unstable: the smallest push along a mode with a negative "
                      "eigenvalue makes the structure leave it, as a column beyond its buckling load does");
         break;
      }
   return {};
}

void modes(const ModesOptions &options, Context &context)
{
   const auto input = openToRun(options.run, context, [&](Design &design) {
      design.setup.solverValues["modes"] = static_cast<double>(options.count);
      return Status();
   });
   if (!input)
      return;
   if (const Status found = findInput(*input, options, context); !found)
      context.fail(found.error());
}

} // namespace

void addModes(CLI::App &app, Context &context)
{
   const auto options = std::make_shared<ModesOptions>();
   CLI::App *command =
       app.add_subcommand("modes", "Find the lowest frequencies of vibration about the static balance");
   addModelOptions(*command, options->run);
   command->add_option("-n,--count", options->count, "How many modes")
       ->check(CLI::Range(1, 1000))
       ->capture_default_str();
   command
       ->add_option("--at", options->at,
                    "Time at which curves and signals are taken, s (default: the end of the longest curve)")
       ->check(kNonNegative);
   command->add_option("--shapes", options->shapes,
                       "Write the shapes as CSV: a row for each cell of each mode");
   command->footer(
       "Examples:\n  diatom modes beam.diatom\n  diatom modes beam.diatom -n 4 --shapes shapes.csv "
       "--json");
   command->callback([options, &context] { modes(*options, context); });
}

} // namespace diatom::cli
