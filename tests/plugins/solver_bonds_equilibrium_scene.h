// Bars for static balances, and what holds and drives them.
#pragma once

#include "solver_bonds_scene.h"

namespace diatom::test {

using Props = std::map<std::string, double>;
inline const Props kRubber{{"density", 1000}, {"youngs_modulus", 1e6}, {"poisson_ratio", 0.3}};

/// A bar of cells along x, the first one clamped.
inline HandScene bar(int bonds, double pitch, Props material)
{
   HandScene scene(pitch);
   scene.analysis = "statics";
   scene.addMaterial(std::move(material));
   scene.addBlock(bonds + 1, 1, 1);
   scene.link();
   scene.fix(0);
   scene.effects = {"rotation", "loads"};
   return scene;
}

/// Drives a degree of freedom along a curve of its own: straight from (0, 0) to (1, value).
inline void drive(HandScene &scene, int cell, int freedom, double value)
{
   const auto curve = static_cast<std::int64_t>(scene.channels["driven"].where.size());
   scene.addRow("driven", {double(freedom), double(curve)}, cell);
   scene.addRow("curve", {0, 0}, curve);
   scene.addRow("curve", {1, value}, curve);
}

inline std::string text(const Run &run) { return run.host.said; }

} // namespace diatom::test
