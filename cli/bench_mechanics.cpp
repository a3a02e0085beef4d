// Benchmarks of motion in time: dense blocks, many materials, sparse shapes, other lattices, small scenes.
#include "cli/bench.h"

#include "cells/hierarchy.h"
#include "formats/files.h"
#include "scene/solver_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <map>

namespace diatom::cli {

namespace {

struct Row
{
   std::string name, what, lattice = "cube";
   int edge = 10;
   int materials = 1;
   double filled = 1;
   bool single = false;
   std::string instructions = "best";
   bool reproducible = false;
   int threads = 1;
   std::string sample{}; // of resources/samples, instead of a block
   bool damped = false, smallTurns = false;
};

/// Repeatable noise, 0 to 1 (Numerical Recipes, 2nd ed., section 7.1).
class RandomNumbers
{
public:
   double next()
   {
      m_state = m_state * 1664525U + 1013904223U;
      return static_cast<double>(m_state >> 8) / 16777216.0;
   }

private:
   std::uint32_t m_state = 1;
};

/// A block held at the bottom under gravity.
Design blockOf(const Row &row)
{
   Design design;
   design.name = row.name;
   design.model.lattice.id = "org.diatom_cad.lattice." + row.lattice;
   std::vector<MaterialIndex> materials;
   for (int m = 0; m < row.materials; ++m) {
      Material one;
      one.id = one.name = fmt::format("rubber-{}", m);
      one.density = 1100 + 20 * m;
      one.youngsModulus = 1e6 * (1 + 0.1 * m);
      one.dampingRatio = row.damped ? 0.1 : 0;
      if (row.materials > 1) { // constants that differ by direction, so that turning a cell matters
         BondConstants k;
         const double a = 1000 * (1 + 0.1 * m);
         k.axial = {a, 1.1 * a, 1.2 * a};
         k.shear = {{{0, 0.4 * a, 0.41 * a}, {0.42 * a, 0, 0.43 * a}, {0.44 * a, 0.45 * a, 0}}};
         k.bending = {8e-8 * a, 8.1e-8 * a, 8.2e-8 * a};
         k.torsion = {5e-8 * a, 5.1e-8 * a, 5.2e-8 * a};
         one.bonds = k;
      }
      const auto index = design.model.setMaterial(one);
      materials.push_back(index ? *index : MaterialIndex{0});
   }
   CellArray &cells = design.model.root.cells;
   RandomNumbers noise;
   const int last = row.edge - 1;
   if (row.materials == 1 && row.filled == 1)
      cells.fill({{0, 0, 0}, {last, last, last}}, Cell{materials[0], 0, 0});
   else
      for (int x = 0; x <= last; ++x)
         for (int y = 0; y <= last; ++y)
            for (int z = 0; z <= last; ++z) {
               const auto material = static_cast<std::size_t>(noise.next() * row.materials);
               const auto turn = row.materials > 1 ? static_cast<std::uint8_t>(noise.next() * 24) : 0;
               if (noise.next() < row.filled)
                  cells.set({x, y, z}, Cell{materials[material], static_cast<std::uint8_t>(turn), 0});
            }
   design.setup.supports = {{Box{{0, 0, 0}, {last, last, 0}}, kAllFreedoms}};
   design.setup.gravity = {0, 0, -9.81};
   if (row.smallTurns)
      design.setup.effects["rotation"] = false;
   return design;
}

Result<Design> designOf(const Row &row, const Job &job)
{
   if (row.sample.empty())
      return blockOf(row);
   auto opened = openDesign(std::filesystem::path("resources/samples") / (row.sample + ".diatom"), job);
   if (!opened)
      return Error{opened.error().code, opened.error().message + " (run this from the source folder)"};
   return std::move(opened->design);
}

const std::list<Row> &rows()
{
   static const std::list<Row> all = [] {
      std::list<Row> list;
      const auto add = [&](Row row, const char *what) {
         row.what = what;
         list.push_back(std::move(row));
      };
      for (const bool single : {true, false}) {
         const char *type = single ? "f32" : "f64";
         for (const int n : {7, 10, 20, 28, 40, 64, 100})
            add({fmt::format("dense-{}-{}", n, type), "", "cube", n, 1, 1, single},
                "a block of one material");
         for (const int n : {28, 100})
            add({fmt::format("dense-{}-{}-avx2", n, type), "", "cube", n, 1, 1, single, "avx2"},
                "the same with AVX2 at most");
         add({fmt::format("dense-28-{}-reproducible", type), "", "cube", 28, 1, 1, single, "best", true},
             "the same with bits that no processor changes");
         for (const int n : {28, 64, 100})
            add({fmt::format("dense-{}-{}-2-threads", n, type), "", "cube", n, 1, 1, single, "best", false,
                 2},
                "the same on two threads");
         Row damped{fmt::format("damped-28-{}", type), "", "cube", 28, 1, 1, single};
         damped.damped = true;
         add(damped, "a block with damping, as the samples have it");
         for (const int n : {28, 100}) {
            Row small{fmt::format("small-turns-{}-{}", n, type), "", "cube", n, 1, 1, single};
            small.smallTurns = true;
            add(small, "a block whose strains are linear, with rotation switched off");
         }
         for (const int n : {28, 64})
            add({fmt::format("materials-{}-{}", n, type), "", "cube", n, 12, 1, single},
                "twelve materials at random, turned at random");
         add({fmt::format("half-28-{}", type), "", "cube", 28, 1, 0.5, single},
             "half of the cells, at random");
         for (const char *lattice : {"kelvin", "kelvin_body_centred", "octahedron_edge", "gik"})
            add({fmt::format("{}-20-{}", lattice, type), "", lattice, 20, 1, 1, single}, "another lattice");
      }
      for (const char *sample :
           {"bending-beam", "octahedral-truss", "undulating-spine", "walker", "xy-stage"})
         for (const int threads : {1, 2})
            add({fmt::format("{}{}", sample, threads == 2 ? "-2-threads" : ""), "", "", 0, 1, 1, false,
                 "best", false, threads, sample},
                "a sample with all its effects");
      return list;
   }();
   return all;
}

/// Operations of a bond and of a cell, multiplications and additions, as the bond law needs them at least.
constexpr double kBondFlops = 233, kCellFlops = 95, kSmallBondFlops = 31, kSmallCellFlops = 42;

double peak(bool single)
{
   static std::map<bool, double> known;
   if (!known.contains(single))
      known[single] = peakGflops(single);
   return known[single];
}

Status runRow(Measure &measure)
{
   const auto found =
       std::find_if(rows().begin(), rows().end(), [&](const Row &r) { return r.name == measure.name(); });
   Row row = *found;
   if (measure.quick())
      row.edge = std::min(row.edge, 20);
   Job job;
   job.setThreads(row.threads);
   auto design = designOf(row, job);
   if (!design)
      return design.error();
   const auto lattice = Lattice::make(*measure.catalogue(), design->model.lattice, job);
   if (!lattice)
      return lattice.error();
   const Hierarchy hierarchy(*lattice, design->model);
   auto scene = Scene::build(hierarchy, design->setup, job);
   if (!scene)
      return scene.error();
   Values values{{"precision", std::string(row.single ? "f32" : "f64")}, {"instructions", row.instructions}};
   if (row.reproducible)
      values["reproducible"] = 1.0;
   const std::uint64_t empty = residentBytes();
   const auto solver = SolverRun::create(measure.catalogue(), *std::move(scene), design->setup, values, job);
   if (!solver)
      return solver.error();
   SolverRun &run = **solver;
   const auto cells = static_cast<double>(run.scene().cells()),
              links = static_cast<double>(run.scene().view().links);
   const double steps = std::ceil((measure.quick() ? 1e5 : 4e6) / cells / (row.sample.empty() ? 1 : 4));
   const diatom_step_request request{sizeof(diatom_step_request), 1e9, 0, static_cast<std::int64_t>(steps),
                                     0};
   diatom_step_result result{};
   result.size = sizeof result;
   Status done = run.step(request, result, job); // warms up
   measure.time(7, [&] {
      if (done)
         done = run.step(request, result, job);
   });
   if (!done)
      return done;
   if (result.state == DIATOM_DIVERGED)
      return Error{ErrorCode::unstable, fmt::format("{} diverged", row.name)};
   measure.did(cells * steps, "cell-steps");
   const double ns = 1e9 / measure.rate();
   measure.also("cells", cells);
   measure.also("bonds", links);
   measure.also("ns_per_cell_step", ns);
   measure.also("ns_per_bond_step", ns * cells / links);
   const double flops = row.smallTurns ? links * kSmallBondFlops + cells * kSmallCellFlops
                                       : links * kBondFlops + cells * kCellFlops;
   measure.also("of_fma_peak", flops / cells / ns / peak(row.single) / row.threads);
   measure.also("solver_bytes_per_cell", static_cast<double>(residentBytes() - empty) / cells);
   Hasher hasher;
   for (const char *name : {"position", "rotation", "velocity", "angular_velocity"}) {
      const auto values_of = run.output(name, job);
      if (!values_of)
         return values_of.error();
      hasher.add(std::span<const double>(*values_of));
   }
   measure.result(hasher.finish());
   return {};
}

} // namespace

std::span<const Benchmark> mechanicsBenchmarks()
{
   static const std::vector<Benchmark> all = [] {
      std::vector<Benchmark> list;
      for (const Row &row : rows())
         list.push_back({row.name, row.what, runRow});
      return list;
   }();
   return all;
}

} // namespace diatom::cli
