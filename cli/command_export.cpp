// diatom export: a design as STL, of cells or of parts, whole or by material.
#include "cli/commands.h"
#include "cli/number_checks.h"

#include "io/stl.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <optional>
#include <utility>

namespace diatom::cli {

namespace {

constexpr std::array<std::pair<const char *, double>, 6> kUnits = {
    {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}, {"in", 25.4e-3}}};

/// Cells up to which contacts are counted: a surface that takes a second and some 100 MB.
constexpr std::uint64_t kMostCounted = 1'000'000;

struct ExportArguments
{
   std::string file, out, as = "cells", material, unit = "mm", parts;
   bool eachMaterial = false, ascii = false;
   int detail = -1;
};

std::vector<std::string> unitNames()
{
   std::vector<std::string> names;
   for (const auto &[name, metres] : kUnits)
      names.emplace_back(name);
   return names;
}

Result<StlOptions> optionsOf(const ExportArguments &arguments, const Model &model)
{
   StlOptions options;
   options.what = arguments.as == "parts" ? StlOptions::What::parts : StlOptions::What::cells;
   options.ascii = arguments.ascii;
   options.detail = arguments.detail;
   for (const auto &[name, metres] : kUnits)
      if (arguments.unit == name)
         options.unit = metres;
   if (arguments.material.empty())
      return options;
   const MaterialIndex material = model.material(arguments.material);
   if (material == 0) {
      std::string known;
      for (const Material &each : *model.materials)
         if (!each.id.empty())
            known += (known.empty() ? "" : ", ") + each.id;
      return Error{ErrorCode::usage, fmt::format("{} has no material \"{}\"; it has {}", arguments.file,
                                                 arguments.material, known.empty() ? "none" : known)};
   }
   options.material = material;
   return options;
}

nlohmann::ordered_json reportOf(const std::vector<StlReport> &reports, const ExportArguments &arguments,
                                const Model &model)
{
   auto files = nlohmann::ordered_json::array();
   for (const StlReport &report : reports) {
      nlohmann::ordered_json file{{"file", report.file.string()}};
      if (report.material)
         file["material"] = model.material(*report.material).id;
      file["triangles"] = report.triangles;
      file["bytes"] = report.bytes;
      file["cells"] = report.cells;
      if (arguments.as == "parts")
         file["parts"] = report.parts;
      if (report.edgeContacts)
         file["edge_contacts"] = *report.edgeContacts;
      if (report.vertexContacts)
         file["vertex_contacts"] = *report.vertexContacts;
      files.push_back(std::move(file));
   }
   return {{"as", arguments.as}, {"unit", arguments.unit}, {"files", std::move(files)}};
}

Result<std::vector<StlReport>> write(const ExportArguments &arguments, const Context::Input &input,
                                     Context &context)
{
   const Model &model = input.hierarchy->model();
   auto options = optionsOf(arguments, model);
   if (!options)
      return options.error();
   options->contacts = input.hierarchy->cells() <= kMostCounted;
   std::shared_ptr<const PartMaker> maker;
   if (options->what == StlOptions::What::parts) {
      auto made = PartMaker::make(*context.catalogue(), arguments.parts, {}, model.lattice.id, context.job());
      if (!made)
         return made.error();
      maker = *std::move(made);
   }
   if (arguments.eachMaterial)
      return writeStlByMaterial(*input.hierarchy, maker.get(), *options, arguments.out, context.job());
   auto report = writeStl(*input.hierarchy, maker.get(), *options, arguments.out, context.job());
   if (!report)
      return report.error();
   return std::vector<StlReport>{*std::move(report)};
}

void run(const ExportArguments &arguments, Context &context)
{
   const auto suffix = std::filesystem::path(arguments.out).extension();
   if (arguments.out != "-" && suffix != ".stl" && suffix != ".STL") {
      context.fail(
          {ErrorCode::usage,
           fmt::format("{}: the format is told by the suffix, and only .stl is known", arguments.out)});
      return;
   }
   const auto input = context.open(arguments.file);
   if (!input)
      return;
   const auto reports = write(arguments, *input, context);
   if (!reports) {
      context.fail(reports.error());
      return;
   }
   if (arguments.out != "-") // standard output carries the file itself
      context.print(reportOf(*reports, arguments, input->hierarchy->model()));
}

} // namespace

void addExport(CLI::App &app, Context &context)
{
   auto arguments = std::make_shared<ExportArguments>();
   auto *command = app.add_subcommand("export", "Write a design as STL");
   command->add_option("FILE", arguments->file, "A design, - for standard input")->required();
   command->add_option("OUT", arguments->out, "The .stl file, - for standard output")->required();
   command->add_option("--as", arguments->as, "Cells as their polyhedra, or the parts that are really made")
       ->check(CLI::IsMember({"cells", "parts"}))
       ->capture_default_str();
   auto *material = command->add_option("--material", arguments->material, "Only the material of this id");
   command->add_flag("--each-material", arguments->eachMaterial, "One file per material: OUT.MATERIAL.stl")
       ->excludes(material);
   command->add_option("--parts", arguments->parts,
                       "Which parts, when several fit the lattice: see diatom parts");
   command->add_option("--detail", arguments->detail, "Mesh detail of parts, 0 coarse; the finest by default")
       ->check(kNonNegative);
   command->add_flag("--ascii", arguments->ascii, "ASCII instead of binary STL");
   command->add_option("--unit", arguments->unit, "Length of one STL unit")
       ->check(CLI::IsMember(unitNames()))
       ->capture_default_str();
   command->callback([arguments, &context] { run(*arguments, context); });
}

} // namespace diatom::cli
