// The effects table. A row looks at the scene and says whether it calls for the effect, and why; adding an
// effect adds a row. Costs are measured by benchmarks, so that the table itself has none.
#include "scene/effect_looks.h"

#include "core/text.h"
#include "scene/fields.h"
#include "scene/where.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace diatom {

namespace {

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

template<typename Item>
std::vector<Index> firstCells(const std::vector<Item> &items)
{
   std::vector<Index> cells;
   for (std::size_t i = 0; i < std::min(items.size(), kEvidence); ++i)
      cells.push_back(items[i].cell);
   return cells;
}

/// Cells of the entries, up to a few, in the entries' order.
template<typename Item>
std::vector<Index> cellsOf(const Look &look, const std::vector<const Item *> &items)
{
   std::vector<Index> cells;
   for (std::size_t i = 0; i < items.size() && cells.size() < kEvidence; ++i)
      for (const Index cell : someCells(look.hierarchy, items[i]->where, kEvidence - cells.size()))
         if (std::find(cells.begin(), cells.end(), cell) == cells.end())
            cells.push_back(cell);
   return cells;
}

/// "3 loads are set, the first on cell (1, 2, 3)".
template<typename Item>
std::string countText(const std::vector<const Item *> &items, const char *one, const char *many)
{
   const std::string first = whereText(items.front()->where);
   return items.size() == 1 ? fmt::format("one {} on {}", one, first)
                            : fmt::format("{} {}, the first on {}", items.size(), many, first);
}

Verdict lookRotation(const Look &look)
{
   if (look.hierarchy.cells() < 2)
      return {false, "a single cell has no bond that could turn", {}};
   return {
       true,
       "bonded cells may turn by any angle, and the law is exact for all; where no turn matters, switching "
       "it off takes strains to be linear, at a fraction of the cost",
       cellsWhere(look, [](Cell) { return true; })};
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
   if (auto still = withoutMotion(look))
      return *std::move(still);
   if (look.setup.drag <= 0)
      return {false, "no drag is set", {}};
   return {true, fmt::format("drag slows all motion at {} per second", numberText(look.setup.drag)), {}};
}

Verdict lookLoads(const Look &look)
{
   std::vector<const Load *> loads;
   for (const Load &load : look.setup.loads)
      if (load.force != std::array<double, 3>{} || load.moment != std::array<double, 3>{})
         loads.push_back(&load);
   if (loads.empty())
      return {false, "no load is set", {}};
   return {true, countText(loads, "load acts", "loads act"), cellsOf(look, loads)};
}

Verdict lookDriven(const Look &look)
{
   std::vector<const Drive *> drives;
   for (const Drive &drive : look.setup.drives)
      drives.push_back(&drive);
   if (drives.empty())
      return {false, "no freedom is driven along a curve", {}};
   return {true, countText(drives, "curve drives a freedom", "curves drive freedoms"), cellsOf(look, drives)};
}

Verdict lookSelfContact(const Look &)
{
   return {false, "not available in this version: cells that are not joined pass through each other", {}};
}

Verdict lookPotentialField(const Look &)
{
   return {false, "not available in this version: the space around conductors carries no field", {}};
}

constexpr std::array<Row, 15> kEffects{{
    {"rotation", true, Forcing::harmless, lookRotation},
    {"damping", true, Forcing::harmless, lookDamping},
    {"gravity", true, Forcing::harmless, lookGravity},
    {"actuation", true, Forcing::harmless, lookActuation},
    {"electronics", false, Forcing::impossible, lookElectronics},
    {"ground", true, Forcing::needsScene, lookGround},
    {"friction", true, Forcing::needsScene, lookFriction},
    {"drag", true, Forcing::harmless, lookDrag},
    {"loads", true, Forcing::harmless, lookLoads},
    {"driven", true, Forcing::harmless, lookDriven},
    {"self-contact", false, Forcing::impossible, lookSelfContact},
    {"orientation", false, Forcing::needsScene, lookOrientation},
    {"solid", true, Forcing::needsScene, lookSolid},
    {"poisson", true, Forcing::harmless, lookPoisson},
    {"potential-field", false, Forcing::impossible, lookPotentialField},
}};

/// A field acts where it is set: the solver must know it, or the user leave it out.
Verdict lookField(const Look &look, std::string_view name)
{
   std::vector<const Field *> fields;
   for (const Field &field : look.setup.fields)
      if (field.name == name)
         fields.push_back(&field);
   return {true, countText(fields, "value is set", "values are set"), cellsOf(look, fields)};
}

Effect plan(const char *name, Forcing forcing, Verdict verdict, const Look &look)
{
   Effect effect{name, verdict.on, false, std::move(verdict.why), std::move(verdict.evidence), std::nullopt};
   const auto asked = look.setup.effects.find(name);
   if (asked == look.setup.effects.end())
      return effect;
   effect.forced = true;
   if (!asked->second) {
      effect.why = verdict.on ? "switched off, although " + effect.why : "switched off; also, " + effect.why;
      effect.on = false;
   } else if (!verdict.on && forcing == Forcing::harmless) {
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

std::vector<Effect> planEffects(const Hierarchy &hierarchy, const Setup &setup, const Networks &networks,
                                Analysis analysis)
{
   const Look look{hierarchy, setup, networks, analysis};
   std::vector<Effect> effects;
   for (const Row &row : kEffects)
      effects.push_back(plan(row.name, row.forcing, row.look(look), look));
   for (const std::string &field : fieldNames(setup))
      effects.push_back(plan(field.c_str(), Forcing::harmless, lookField(look, field), look));
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

bool effectIsMechanical(std::string_view name)
{
   return std::any_of(kEffects.begin(), kEffects.end(), [&](const Row &row) { return name == row.name; });
}

bool effectIsForSolver(std::string_view name)
{
   return !effectIsMechanical(name) || std::any_of(kEffects.begin(), kEffects.end(), [&](const Row &row) {
      return row.forSolver && name == row.name;
   });
}

} // namespace diatom
