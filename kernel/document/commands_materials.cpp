// Commands on the palette and the lattice.
#include "cells/turns.h"
#include "document/command_edit.h"

#include <fmt/format.h>

namespace diatom {

namespace {

/// Bodies that use a material: the assembly's, then the definitions'.
std::uint64_t uses(const Model &model, MaterialIndex material)
{
   const auto in = [material](const Body &body) {
      const auto counts = body.cells.countByMaterial();
      return material < counts.size() ? counts[material] : 0;
   };
   std::uint64_t cells = in(model.root);
   for (const auto &[number, definition] : model.definitions)
      cells += in(definition->body);
   return cells;
}

Result<std::string> setMaterial(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "set-material", arguments);
   const auto id = edit.arguments().at("id").identifier();
   // What is not given stays as it is.
   nlohmann::json merged = nlohmann::json::object();
   if (const auto number = edit.model().material(id); number != 0 && edit.ok())
      merged = nlohmann::json(materialJson(edit.model().material(number)));
   if (edit.ok())
      merged.merge_patch(edit.arguments().json());
   ReadLog log{"set-material", {}, nlohmann::json::object()};
   const auto material = edit.ok() ? readMaterial(JsonPlace(merged, log)) : Material();
   if (log.error)
      edit.fail(ErrorCode::usage, log.error->message.substr(log.name.size() + 2));
   if (edit.ok()) {
      const auto set = edit.model().setMaterial(material);
      if (!set)
         edit.fail(set.error().code, set.error().message);
   }
   return edit.commit(fmt::format("set material {}", id));
}

Result<std::string> removeMaterial(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "remove-material", arguments);
   const auto material = edit.material("id");
   const auto cells = edit.ok() ? uses(edit.model(), material) : 0;
   if (cells > 0)
      edit.fail(ErrorCode::invalid,
                fmt::format("{} cells are made of it; replace or erase them first", cells));
   std::string id;
   if (edit.ok()) {
      auto materials = *edit.model().materials;
      id = materials[material - 1U].id;
      materials[material - 1U] = Material(); // keeps its place: cells name materials by number
      edit.model().materials = std::make_shared<const std::vector<Material>>(std::move(materials));
      const auto on = [&id](const auto &item) {
         const auto *of = std::get_if<OfMaterial>(&item.where);
         return of && of->id == id;
      };
      Setup &setup = edit.design().setup;
      std::erase_if(setup.supports, on);
      std::erase_if(setup.drives, on);
      std::erase_if(setup.loads, on);
      std::erase_if(setup.starts, on);
      std::erase_if(setup.fields, on);
   }
   return edit.commit(fmt::format("remove material {}", id));
}

Result<std::string> replaceMaterial(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "replace-material", arguments);
   const auto from = edit.material("from"), to = edit.material("to");
   if (edit.ok()) {
      edit.model().root.cells.replaceMaterial(from, to);
      for (auto &[number, definition] : edit.model().definitions) {
         const auto counts = definition->body.cells.countByMaterial();
         if (from >= counts.size() || counts[from] == 0)
            continue; // stays shared with the design before
         auto changed = std::make_shared<Definition>(*definition);
         changed->body.cells.replaceMaterial(from, to);
         definition = std::move(changed);
      }
   }
   return edit.commit("replace material");
}

/// Cells keep their indices on another lattice, but turned cells, super-cells and composites mean something
/// else there.
bool plainCells(const Model &model)
{
   if (!model.definitions.empty())
      return false;
   return model.root.cells.visit([](Index, Cell cell) { return cell.orientation == 0 && cell.joins == 0; });
}

Result<std::string> setLattice(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "set-lattice", arguments);
   const auto &given = edit.arguments();
   auto &lattice = edit.model().lattice;
   const auto old = lattice;
   if (given.has("id")) {
      lattice.id = given.at("id").identifier();
      if (lattice.id.find('.') == std::string::npos)
         lattice.id = "org.diatom_cad.lattice." + lattice.id;
      if (lattice.id != old.id)
         lattice.values.clear();
   }
   if (given.has("values"))
      lattice.values = given.at("values").values();
   lattice.pitch = given.numberOr("pitch_m", lattice.pitch, 1e-12, 1e6);
   if (given.has("aspect") && given.at("aspect").array(3))
      for (std::size_t a = 0; a < 3; ++a)
         lattice.aspect[a] = given.at("aspect").at(a).number(1e-6, 1e6);
   if (edit.ok() && lattice.id != old.id && !plainCells(edit.model()))
      edit.fail(ErrorCode::invalid,
                "composites, super-cells and turned cells do not carry over to another lattice; start a new "
                "design for it");
   if (edit.ok()) {
      const auto made = Lattice::make(edit.catalogue(), lattice, edit.job());
      const Status fits = made ? checkTurns(edit.model(), **made) : Status(made.error());
      if (!fits)
         edit.fail(fits.error().code, fits.error().message);
   }
   return edit.commit("set lattice");
}

constexpr CommandParameter kSetMaterial[] = {
    {"id", "text", true, "id of a new or known material; what is not given stays as it is"},
    {"name", "text", false, "name for people"},
    {"color", "text", false, "like #cda4f3"},
    {"density_kg_m3", "number", false, "mass of a solid cell over its volume"},
    {"youngs_modulus_Pa", "number", false, "stiffness"},
    {"poisson_ratio", "number", false, "sideways strain over strain"},
    {"damping_ratio", "number", false, "of each bond, 1 = critical"},
    {"role", "text", false, "insulator, conductor, source or actuator"},
    {"cell_model", "text", false, "bond, block (bonds with constants for filled blocks) or solid"},
    {"poisson_coupling", "boolean", false, "sideways strain follows axial strain in bonds"},
    {"bonds", "object", false, "the fifteen stiffnesses, instead of Young's modulus and Poisson's ratio"},
    {"dampings", "object", false, "the fifteen dampings, instead of the damping ratio"},
    {"inertia_kg_m2", "list", false, "of a cell about its own axes, instead of that of a full box"},
    {"ports", "list", false, "faces that conduct: \"-x\", \"+x\", ..."},
    {"actuation", "object", false, "mode, axis, strain_per_V, axis_from_wires"},
    {"properties", "object", false, "numbers by name, for solvers of other physics than mechanics"},
};
constexpr CommandParameter kId[] = {{"id", "material", true, "id of the material"}};
constexpr CommandParameter kReplace[] = {
    {"from", "material", true, "id of the material to replace"},
    {"to", "material", true, "id of the material that takes its place"},
};
constexpr CommandParameter kLattice[] = {
    {"id", "text", false, "like kelvin or org.diatom_cad.lattice.kelvin"},
    {"values", "object", false, "the lattice's own parameters"},
    {"pitch_m", "number", false, "metres per lattice unit"},
    {"aspect", "list", false, "scale along x, y and z"},
};

constexpr Command kMaterialTable[] = {
    {"set-material", "Set material", "Adds a material or changes one.", kSetMaterial, setMaterial},
    {"remove-material", "Remove material", "Removes a material that no cell is made of.", kId,
     removeMaterial},
    {"replace-material", "Replace material",
     "Makes everything of one material of another, composites included.", kReplace, replaceMaterial},
    {"set-lattice", "Set lattice", "Changes the lattice, its pitch or its parameters.", kLattice, setLattice},
};

} // namespace

const std::span<const Command> kMaterialCommands = kMaterialTable;

} // namespace diatom
