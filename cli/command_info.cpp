// diatom info: what a file holds, counted on the hierarchy.
#include "cli/commands.h"

#include <CLI/CLI.hpp>

#include <memory>

namespace diatom::cli {

namespace {

nlohmann::ordered_json indexJson(Index i) { return {i.x, i.y, i.z}; }

void showInfo(Context &context, const std::string &file)
{
   const auto input = context.open(file);
   if (!input)
      return;
   const Hierarchy &hierarchy = *input->hierarchy;
   const Model &model = hierarchy.model();
   const Box bounds = hierarchy.bounds();
   auto materials = nlohmann::ordered_json::object();
   const auto counts = hierarchy.countByMaterial();
   for (std::size_t m = 1; m < counts.size(); ++m)
      if (counts[m] > 0)
         materials[model.material(static_cast<MaterialIndex>(m)).id] = counts[m];
   const Design &design = input->opened.design;
   nlohmann::ordered_json info = {{"name", design.name},
                                  {"format", input->opened.format},
                                  {"lattice", model.lattice.id},
                                  {"pitch_m", model.lattice.pitch},
                                  {"cells", hierarchy.cells()},
                                  {"stored_cells", hierarchy.stored()},
                                  {"composites", model.definitions.size()},
                                  {"depth", hierarchy.depth()},
                                  {"bounds", nullptr},
                                  {"materials", materials},
                                  {"mass_kg", hierarchy.mass().mass},
                                  {"supports", design.setup.supports.size()},
                                  {"loads", design.setup.loads.size()},
                                  {"sources", design.setup.sources.size()},
                                  {"hash", design.hash().text()}};
   if (!bounds.empty())
      info["bounds"] = {indexJson(bounds.min), indexJson(bounds.max)};
   context.print(info);
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
