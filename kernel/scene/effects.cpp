// The effects table. A row looks at the scene and says whether it calls for the effect, and why; adding an
// effect adds a row. Costs are measured by benchmarks, so that the table itself has none.
#include "scene/effects.h"

#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace diatom {

namespace {

constexpr std::size_t kEvidence = 3;
/// Cells looked at for evidence; a material that turns up later is named without a cell.
constexpr std::int64_t kSearched = 20'000'000;

struct Look
{
   const Hierarchy &hierarchy;
   const Setup &setup;
   const Networks &networks;
};

struct Verdict
{
   bool on = false;
   std::string why;
   std::vector<Index> evidence;
};

/// What forcing an effect on means where the scene does not call for it.
enum class Forcing : std::uint8_t {
   harmless,   // it runs and contributes nothing
   needsScene, // there is nothing it could act on
   impossible  // not in this version
};

struct Row
{
   const char *name;
   bool forSolver;
   Forcing forcing;
   Verdict (*look)(const Look &);
};

std::vector<Index> cellsWhere(const Look &look, const std::function<bool(Cell)> &wanted)
{
   std::vector<Index> cells;
   std::int64_t seen = 0;
   look.hierarchy.visit(look.hierarchy.bounds(), [&](Index i, Cell cell) {
      if (wanted(cell))
         cells.push_back(i);
      return cells.size() < kEvidence && ++seen < kSearched;
   });
   std::sort(cells.begin(), cells.end());
   return cells;
}

template<typename Item>
std::vector<Index> firstCells(const std::vector<Item> &items)
{
   std::vector<Index> cells;
   for (std::size_t i = 0; i < std::min(items.size(), kEvidence); ++i)
      cells.push_back(items[i].cell);
   return cells;
}

/// Materials in use for which `holds`, with up to a few cells of them.
struct MaterialEvidence
{
   std::vector<std::string> ids;
   std::vector<Index> cells;

   std::string names() const
   {
      std::string text;
      for (const auto &id : ids)
         text += (text.empty() ? "" : ", ") + id;
      return text;
   }
};

MaterialEvidence materialsWhere(const Look &look, bool (*holds)(const Material &))
{
   const auto &materials = *look.hierarchy.model().materials;
   const auto counts = look.hierarchy.countByMaterial();
   std::vector<bool> found(materials.size() + 1, false);
   MaterialEvidence evidence;
   for (std::size_t m = 1; m <= materials.size() && m < counts.size(); ++m) {
      found[m] = counts[m] > 0 && holds(materials[m - 1]);
      if (found[m])
         evidence.ids.push_back(materials[m - 1].id);
   }
   if (!evidence.ids.empty())
      evidence.cells = cellsWhere(look, [&](Cell cell) { return found[cell.material]; });
   return evidence;
}

Verdict lookRotation(const Look &look)
{
   if (look.hierarchy.cells() < 2)
      return {false, "a single cell has no bond that could turn", {}};
   return {true, "bonded cells may turn by any angle", cellsWhere(look, [](Cell) { return true; })};
}

Verdict lookDamping(const Look &look)
{
   const auto damped =
       materialsWhere(look, [](const Material &material) { return material.dampingRatio > 0; });
   if (damped.ids.empty())
      return {false, "no material in use has a damping ratio", {}};
   return {true, "materials with a damping ratio: " + damped.names(), damped.cells};
}

Verdict lookGravity(const Look &look)
{
   const auto &g = look.setup.gravity;
   if (g == std::array<double, 3>{})
      return {false, "gravity is zero", {}};
   return {true,
           fmt::format("gravity is ({}, {}, {}) m/s2", numberText(g[0]), numberText(g[1]), numberText(g[2])),
           {}};
}

Verdict lookActuation(const Look &look)
{
   if (look.networks.actuators.empty()) {
      const auto actuators = materialsWhere(
          look, [](const Material &material) { return material.role == ElectricalRole::actuator; });
      return {false, actuators.ids.empty() ? "no actuator in the scene" : "no actuator is wired",
              actuators.cells};
   }
   std::vector<Index> driven;
   for (const DrivenActuator &actuator : look.networks.actuators)
      for (const int net : {actuator.netA, actuator.netB}) {
         const int source = look.networks.nets[static_cast<std::size_t>(net)].source();
         if (source >= 0 && look.setup.sources[static_cast<std::size_t>(source)].amplitude != 0) {
            driven.push_back(actuator.cell);
            break;
         }
      }
   if (driven.empty())
      return {false, "no actuator's net has a source with a voltage", firstCells(look.networks.actuators)};
   const std::size_t count = driven.size();
   driven.resize(std::min(count, kEvidence));
   return {true, fmt::format("{} actuators are driven by sources", count), driven};
}

Verdict lookElectronics(const Look &look)
{
   if (look.networks.nets.empty())
      return {false, "no conductor in the scene", {}};
   return {false,
           "not available in this version: wires are ideal, so that each net has its source's voltage",
           {look.networks.nets.front().cells.front()}};
}

Verdict lookGround(const Look &look)
{
   if (!look.setup.ground.present)
      return {false, "no ground is set", {}};
   return {true, fmt::format("a ground lies at z = {} m", numberText(look.setup.ground.height)), {}};
}

Verdict lookFriction(const Look &look)
{
   if (!look.setup.ground.present)
      return {false, "no ground to rub on", {}};
   if (look.setup.ground.friction <= 0)
      return {false, "the ground is smooth", {}};
   return {true,
           fmt::format("the ground's friction coefficient is {}", numberText(look.setup.ground.friction)),
           {}};
}

Verdict lookDrag(const Look &look)
{
   if (look.setup.drag <= 0)
      return {false, "no drag is set", {}};
   return {true, fmt::format("drag slows all motion at {} per second", numberText(look.setup.drag)), {}};
}

Verdict lookLoads(const Look &look)
{
   std::vector<Index> loaded;
   for (const Load &load : look.setup.loads)
      if (load.force != std::array<double, 3>{} || load.moment != std::array<double, 3>{})
         loaded.push_back(load.cell);
   if (loaded.empty())
      return {false, "no load is set", {}};
   const std::size_t count = loaded.size();
   loaded.resize(std::min(count, kEvidence));
   return {true, fmt::format("{} cells carry a load", count), loaded};
}

Verdict lookSelfContact(const Look &)
{
   return {false, "not available in this version: cells that are not joined pass through each other", {}};
}

bool differsByDirection(const Material &material)
{
   const bool sideways = material.actuation.mode == Actuation::Mode::shear ||
                         material.actuation.mode == Actuation::Mode::bending;
   if (material.role == ElectricalRole::actuator && sideways)
      return true; // shears or bends towards a direction of its own
   if (!material.bonds)
      return false;
   const BondConstants &k = *material.bonds;
   const double shear = k.shear[0][1];
   for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis), b = static_cast<std::size_t>((axis + 1) % 3);
      if (k.axial[a] != k.axial[0] || k.bending[a] != k.bending[0] || k.torsion[a] != k.torsion[0] ||
          k.shear[a][b] != shear || k.shear[b][a] != shear)
         return true;
   }
   return false;
}

Verdict lookOrientation(const Look &look)
{
   const auto directed = materialsWhere(look, differsByDirection);
   if (directed.ids.empty())
      return {
          false, "every cell in use is the same in all directions, so that turned cells behave alike", {}};
   return {true,
           "cells differ by direction and are turned with the cell when the scene is built, at no cost in a "
           "step: " +
               directed.names(),
           directed.cells};
}

Verdict lookPoisson(const Look &)
{
   return {false, "not available in this version: bonds along different axes do not couple", {}};
}

Verdict lookPotentialField(const Look &)
{
   return {false, "not available in this version: the space around conductors carries no field", {}};
}

constexpr std::array<Row, 13> kEffects{{
    {"rotation", true, Forcing::harmless, lookRotation},
    {"damping", true, Forcing::harmless, lookDamping},
    {"gravity", true, Forcing::harmless, lookGravity},
    {"actuation", true, Forcing::harmless, lookActuation},
    {"electronics", false, Forcing::impossible, lookElectronics},
    {"ground", true, Forcing::needsScene, lookGround},
    {"friction", true, Forcing::needsScene, lookFriction},
    {"drag", true, Forcing::harmless, lookDrag},
    {"loads", true, Forcing::harmless, lookLoads},
    {"self-contact", false, Forcing::impossible, lookSelfContact},
    {"orientation", false, Forcing::needsScene, lookOrientation},
    {"poisson", false, Forcing::impossible, lookPoisson},
    {"potential-field", false, Forcing::impossible, lookPotentialField},
}};

Effect plan(const Row &row, const Look &look)
{
   Verdict verdict = row.look(look);
   Effect effect{row.name,    verdict.on, false, std::move(verdict.why), std::move(verdict.evidence),
                 std::nullopt};
   const auto asked = look.setup.effects.find(row.name);
   if (asked == look.setup.effects.end())
      return effect;
   effect.forced = true;
   if (!asked->second) {
      effect.why = verdict.on ? "switched off, although " + effect.why : "switched off; also, " + effect.why;
      effect.on = false;
   } else if (!verdict.on && row.forcing == Forcing::harmless) {
      effect.why = "switched on, although " + effect.why;
      effect.on = true;
   } else if (!verdict.on) {
      effect.why = "asked for, but " + effect.why;
   } else {
      effect.why = "asked for, and " + effect.why;
   }
   return effect;
}

} // namespace

std::vector<Effect> planEffects(const Hierarchy &hierarchy, const Setup &setup, const Networks &networks)
{
   const Look look{hierarchy, setup, networks};
   std::vector<Effect> effects;
   for (const Row &row : kEffects)
      effects.push_back(plan(row, look));
   // Friction acts through the ground's pressure: without the one there is nothing of the other.
   const auto named = [&](std::string_view name) {
      return std::find_if(effects.begin(), effects.end(),
                          [&](const Effect &effect) { return effect.name == name; });
   };
   if (!named("ground")->on && named("friction")->on) {
      named("friction")->on = false;
      named("friction")->why = "the ground is switched off";
   }
   return effects;
}

std::vector<std::string> effectNames()
{
   std::vector<std::string> names;
   for (const Row &row : kEffects)
      names.emplace_back(row.name);
   return names;
}

bool effectIsForSolver(std::string_view name)
{
   return std::any_of(kEffects.begin(), kEffects.end(),
                      [&](const Row &row) { return row.forSolver && name == row.name; });
}

} // namespace diatom
