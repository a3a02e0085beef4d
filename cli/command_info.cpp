// diatom info: what a file holds, counted on the hierarchy.
#include "cli/commands.h"
#include "document/missing_lattice.h"

#include <CLI/CLI.hpp>

#include <memory>

namespace diatom::cli {

namespace {

nlohmann::ordered_json indexJson(Index i) { return {i.x, i.y, i.z}; }

nlohmann::ordered_json boundsJson(const Box &bounds)
{
   if (bounds.empty())
      return nullptr;
   return {indexJson(bounds.min), indexJson(bounds.max)};
}

nlohmann::ordered_json materialsJson(const Hierarchy &hierarchy)
{
   auto materials = nlohmann::ordered_json::object();
   const auto counts = hierarchy.countByMaterial();
   for (std::size_t m = 1; m < counts.size(); ++m)
      if (counts[m] > 0)
         materials[hierarchy.model().material(static_cast<MaterialIndex>(m)).id] = counts[m];
   return materials;
}

/// Super-cells among a definition's own cells: runs are counted at their first cell.
std::uint64_t supercells(const Body &body)
{
   std::uint64_t count = 0;
   body.cells.visit([&](Index, Cell cell) {
      count += (cell.joins & Cell::kJoinsPrevious) == 0 ? 1 : 0;
      return true;
   });
   return count;
}

/// What each composite holds, fully expanded; its own super-cells where the lattice has them.
nlohmann::ordered_json definitionsJson(const Context::Input &input)
{
   auto rows = nlohmann::ordered_json::array();
   const Model &model = input.hierarchy->model();
   for (const auto &[id, definition] : model.definitions) {
      Model alone = model;
      alone.root = definition->body;
      const Hierarchy hierarchy(input.lattice, std::move(alone), input.hierarchy.get());
      rows.push_back({{"id", definition->id},
                      {"name", definition->name},
                      {"cells", hierarchy.cells()},
                      {"instances", definition->body.instances.count()},
                      {"bounds", boundsJson(hierarchy.bounds())},
                      {"materials", materialsJson(hierarchy)}});
      if (input.lattice->hasSupercells())
         rows.back()["supercells"] = supercells(definition->body);
   }
   return rows;
}

/// What can be said of cells whose lattice is not installed: nothing about where they are.
void showStored(Context &context, const Opened &opened)
{
   const Model &model = opened.design.model;
   context.print({{"name", opened.design.name},
                  {"format", opened.format},
                  {"lattice", model.lattice.id},
                  {"lattice_installed", false},
                  {"pitch_m", model.lattice.pitch},
                  {"stored_cells", storedCells(model)},
                  {"composites", model.definitions.size()},
                  {"hash", opened.design.hash().text()}});
}

void showInfo(Context &context, const std::string &file)
{
   auto opened = context.read(file);
   if (!opened)
      return;
   if (const auto missing = missingLattice(opened->design, *context.catalogue()); !missing.empty()) {
      context.note(missing);
      showStored(context, *opened);
      return;
   }
   const auto input = context.prepare(*std::move(opened));
   if (!input)
      return;
   const Hierarchy &hierarchy = *input->hierarchy;
   const Model &model = hierarchy.model();
   const Design &design = input->opened.design;
   context.print({{"name", design.name},
                  {"format", input->opened.format},
                  {"lattice", model.lattice.id},
                  {"pitch_m", model.lattice.pitch},
                  {"cells", hierarchy.cells()},
                  {"stored_cells", hierarchy.stored()},
                  {"composites", model.definitions.size()},
                  {"depth", hierarchy.depth()},
                  {"bounds", boundsJson(hierarchy.bounds())},
                  {"materials", materialsJson(hierarchy)},
                  {"mass_kg", hierarchy.mass().mass},
                  {"definitions", definitionsJson(*input)},
                  {"supports", design.setup.supports.size()},
                  {"loads", design.setup.loads.size()},
                  {"sources", design.setup.sources.size()},
                  {"reference_meshes", design.referenceMeshes.size()},
                  {"hash", design.hash().text()}});
}

} // namespace

void addInfo(CLI::App &app, Context &context)
{
   auto *command = app.add_subcommand("info", "Say what a file holds: cells, materials, bounds, mass");
   const auto file = std::make_shared<std::string>();
   command
       ->add_option("FILE", *file,
                    "a .diatom document or a file of AMOEBA or DMDesign; - reads standard input")
       ->required();
   command->callback([&context, file] { showInfo(context, *file); });
}

} // namespace diatom::cli
