// The scene that accuracy is probed on.
#pragma once

#include "kernel/scene_workbench.h"
#include "study/trial.h"

namespace diatom::test {

/// Twelve cells along y, clamped at the root, falling under gravity: first mode some 14 Hz.
inline Workbench cantilever()
{
   Workbench bench;
   Material fibre = material("fibre");
   fibre.density = 3500;
   fibre.youngsModulus = 5e5;
   bench.add(fibre);
   for (std::int32_t y = 0; y < 12; ++y)
      bench.put("fibre", {{0, y, 0}});
   bench.setup.supports = {{Index{0, 0, 0}, 0x3f}};
   bench.setup.gravity = {0, 0, -9.8};
   return bench;
}

inline Subject subjectOf(const Workbench &bench)
{
   return {catalogue(), std::make_shared<const Hierarchy>(bench.hierarchy()), bench.setup};
}

} // namespace diatom::test
