// Designs with a value off its default in every field that a document holds.
#pragma once

#include "document/design.h"

#include <memory>
#include <string>
#include <vector>

namespace diatom::test {

inline Material material(const char *id, ElectricalRole role = ElectricalRole::insulator)
{
   Material m;
   m.id = id;
   m.name = std::string("Name of ") + id;
   m.role = role;
   return m;
}

/// A design with a value off its default in every field that a document holds.
inline Design everything()
{
   Design d;
   d.name = "all \"of\" it, \xc3\xa9";
   d.model.lattice = {"org.example.lattice.unheard_of",
                      {{"height", 1.28}, {"kind", std::string("tall")}},
                      2.5e-4,
                      {1, 2, 0.1}};
   auto a = material("structural"), b = material("brass", ElectricalRole::conductor), gone = material("gone"),
        c = material("act", ElectricalRole::actuator);
   a.color = {1, 0xab, 0xff};
   a.density = 1.0 / 3;
   a.youngsModulus = 6.9e10;
   a.poissonRatio = -0.25;
   a.dampingRatio = 0.17;
   a.bonds =
       BondConstants{{1, 2, 3}, {{{0, 1, 2}, {3, 0, 5}, {6, 7, 0}}}, {1e-6, 2e-6, 3e-6}, {4e-6, 5e-6, 6e-6}};
   b.ports = 0x30;
   c.actuation = {Actuation::Mode::shear, 2, 0.6, true};
   for (auto &m : {a, gone, b, c})
      (void)d.model.setMaterial(m);
   auto palette = *d.model.materials;
   palette[1] = Material();
   palette[1].id.clear(); // removed: keeps its place
   d.model.materials = std::make_shared<const std::vector<Material>>(palette);
   Definition unit{"unit", "Unit", {9, 8, 7}, {}};
   unit.body.cells.fill({{0, 0, 0}, {3, 1, 1}}, {1, 0, 0});
   for (int k = 0; k < 4; ++k)
      unit.body.cells.set({5, k, 0}, {3, 2, static_cast<std::uint8_t>((k > 0 ? 1 : 0) | (k < 3 ? 2 : 0))});
   const auto unitId = *d.model.setDefinition(unit);
   Definition pair{"pair", "Pair", {1, 1, 1}, {}};
   pair.body.instances.insert({unitId, {0, 0, 0}, 0});
   pair.body.instances.insert({unitId, {-9, 4, 2}, 5});
   const auto pairId = *d.model.setDefinition(pair);
   d.model.root.instances.insert({pairId, {100, -100, 1000000}, 0});
   d.model.root.cells.set({kIndexLimit, -kIndexLimit, 0}, {4, 23, 0});
   d.model.root.cells.fill({{-5, -5, -5}, {5, 5, 5}}, {1, 0, 0});
   d.model.root.cells.set({0, 0, 0}, {});
   d.setup.gravity = {0.1, -0.0, -9.8};
   d.setup.supports = {{Index{-5, -5, -5}, 0x3f}, {Index{1, 2, 3}, 0x05}};
   d.setup.loads = {{Index{5, 5, 5}, {1e-3, 0, 0.1}, {0, 1e-9, 0}}};
   d.setup.sources = {{{1, 1, 1}, Waveform::saw, 12.5, 0.33, 0.25, true, 3}};
   d.setup.ground = {true, -5e-4, 999, 0.01, 0.7};
   d.setup.drag = 3;
   d.setup.step = 1e-5;
   d.setup.solver = "org.example.solver.own";
   d.setup.solverValues = {{"theory", std::string("euler")}};
   d.setup.effects = {{"damping", false}, {"gravity", true}};
   d.assembly = {"org.example.parts.p", {{"n", 2.0}}, "org.example.machine.m", {{"feed", 0.01}}};
   return d;
}

/// The fields that came after everything() was written down: where entries of the set-up are, drives, starts,
/// and how cells are modelled.
inline Design boundary()
{
   Design d;
   auto rubber = material("rubber"), clamp = material("clamp");
   rubber.cellModel = CellModel::solid;
   clamp.cellModel = CellModel::block;
   clamp.poissonCoupling = true;
   (void)d.model.setMaterial(rubber);
   (void)d.model.setMaterial(clamp);
   d.model.root.cells.fill({{0, 0, 0}, {9, 2, 2}}, {1, 0, 0});
   d.model.root.cells.fill({{0, 0, 0}, {0, 2, 2}}, {2, 0, 0});
   d.setup.supports = {{Index{1, 0, 0}, 0x07},
                       {Index{1, 0, 0}, 0x08},
                       {Box{{2, 0, 0}, {3, 0, 5}}, 0x04},
                       {OfMaterial{"clamp"}, 0x3f}};
   d.setup.drives = {{Index{9, 0, 0}, 0, {{0, 0}, {0.1, 1e-4}, {0.3, -2.5e-5}}},
                     {Box{{9, 1, 0}, {9, 1, 2}}, 5, {{0, 0.25}}},
                     {OfMaterial{"clamp"}, 3, {{-1, 0}, {1, 3}}}};
   d.setup.loads = {{Box{{8, 0, 0}, {8, 2, 2}}, {0, 0, -1}, {}}, {OfMaterial{"rubber"}, {}, {1e-6, 0, 0}}};
   d.setup.starts = {{Index{5, 0, 0}, {1e-6, 0, 0}, {}, {}, {}, {}},
                     {Box{{4, 0, 0}, {9, 2, 2}}, {}, {0, 0, 0.1}, {0, 0.5, 0}, {0, 0, 7}, {{4e-3, 0, 0}}},
                     {OfMaterial{"rubber"}, {}, {}, {1, 2, 3}, {}, {{0, 0, 0}}}};
   return d;
}

} // namespace diatom::test
