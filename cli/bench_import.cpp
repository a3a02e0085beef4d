// Benchmarks of import: how fast a mesh is filled with cells, by each rule and when it has holes.
#include "cli/bench.h"

#include "cells/model.h"
#include "io/voxelize.h"

#include <cmath>
#include <numbers>

namespace diatom::cli {

namespace {

/// A ball of diameter 1 with a wavy skin, of 2 `rings`^2 triangles. `open`: its cap is missing.
TriangleMesh wavyBall(int rings, bool open)
{
   TriangleMesh mesh;
   const int around = 2 * rings;
   for (int i = 0; i <= rings; ++i)
      for (int k = 0; k < around; ++k) {
         const double polar = std::numbers::pi * i / rings, turn = 2 * std::numbers::pi * k / around;
         const double r = 0.45 + 0.05 * std::sin(6 * polar) * std::cos(8 * turn);
         mesh.vertices.push_back(
             r * Vec3(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)));
      }
   const auto vertex = [&](int i, int k) { return i * around + k % around; };
   for (int i = open ? rings / 16 : 0; i < rings; ++i)
      for (int k = 0; k < around; ++k) {
         if (i > 0)
            mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k), vertex(i, k + 1)});
         if (i + 1 < rings)
            mesh.triangles.push_back({vertex(i, k + 1), vertex(i + 1, k), vertex(i + 1, k + 1)});
      }
   mesh.pieces.resize(1);
   mesh.piece.assign(mesh.triangles.size(), 0);
   return mesh;
}

Status fillBall(Measure &measure, VoxelizeOptions options, bool open)
{
   LatticeSpec spec;
   spec.pitch = measure.quick() ? 1.0 / 50 : 1.0 / 300; // 38 thousand or 10 million cells
   const auto lattice = Lattice::make(*measure.catalogue(), spec, Job());
   if (!lattice)
      return lattice.error();
   const TriangleMesh mesh = wavyBall(measure.quick() ? 32 : 128, open);
   options.closed = !open;
   Status status;
   Model model;
   measure.time(3, [&] {
      const TriangleTree tree(mesh);
      auto filled = voxelize(tree, **lattice, options, Job());
      if (filled)
         model.root.cells = *std::move(filled);
      else
         status = filled.error();
   });
   measure.did(static_cast<double>(model.root.cells.count()), "cells");
   measure.result(model.hash());
   return status;
}

template<BoundaryRule rule>
Status closedBall(Measure &measure)
{
   VoxelizeOptions options;
   options.rule = rule;
   return fillBall(measure, options, false);
}

Status openBall(Measure &measure) { return fillBall(measure, {}, true); }

constexpr Benchmark kImportBenchmarks[] = {
    {"centre", "10^7 cells whose centres lie in a mesh of 65 000 triangles",
     closedBall<BoundaryRule::centre>},
    {"touch", "the same, cells that it touches", closedBall<BoundaryRule::touch>},
    {"fraction", "the same, cells that it fills by half", closedBall<BoundaryRule::fraction>},
    {"open", "the same by centres, with a hole in the mesh", openBall},
};

} // namespace

std::span<const Benchmark> importBenchmarks() { return kImportBenchmarks; }

} // namespace diatom::cli
