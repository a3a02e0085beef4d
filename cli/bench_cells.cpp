// Benchmarks of cells: fills, edits, opening, picking and walking (the figures of the design's kernel
// section).
#include "cli/bench.h"

#include "cells/hierarchy.h"

#include <cmath>
#include <random>

namespace diatom::cli {

namespace {

Hash hashOf(const CellArray &array)
{
   Hasher hasher;
   array.hash(hasher);
   return hasher.finish();
}

/// Four materials without pattern from a linear congruential generator (Numerical Recipes, 2nd ed.,
/// section 7.1).
class RandomCells
{
public:
   Cell next()
   {
      m_state = m_state * 1664525U + 1013904223U;
      return {static_cast<MaterialIndex>(1 + (m_state >> 30)), 0, 0};
   }

private:
   std::uint32_t m_state = 1;
};

/// At least `count` explicit cells as a block of random materials, slab by slab.
CellArray randomBlock(double count)
{
   const auto side = static_cast<std::int32_t>(std::ceil(std::cbrt(count)));
   CellArray array;
   RandomCells noise;
   std::vector<Cell> slab(static_cast<std::size_t>(16) * side * side);
   for (std::int32_t x = 0; x < side; x += 16) {
      const std::int32_t thick = std::min(16, side - x);
      slab.resize(static_cast<std::size_t>(thick) * side * side);
      for (Cell &cell : slab)
         cell = noise.next();
      array.write({{x, 0, 0}, {x + thick - 1, side - 1, side - 1}}, slab);
   }
   return array;
}

Result<std::shared_ptr<const Lattice>> cubeLattice(const Measure &measure)
{
   return Lattice::make(*measure.catalogue(), LatticeSpec(), Job());
}

Model emptyModel()
{
   Model model;
   Material material;
   material.id = "any";
   static_cast<void>(model.setMaterial(material));
   return model;
}

Status fill256(Measure &measure)
{
   CellArray array;
   measure.time(9, [&] {
      array = CellArray();
      array.fill({{3, 5, 7}, {258, 260, 262}}, {1, 0, 0}); // across brick borders on every side
   });
   measure.did(static_cast<double>(array.count()), "cells");
   measure.result(hashOf(array));
   return {};
}

Status fillExplicit(Measure &measure)
{
   const double count = measure.quick() ? 1e6 : 1e8;
   CellArray array;
   measure.time(1, [&] { array = randomBlock(count); });
   measure.did(static_cast<double>(array.count()), "cells");
   measure.result(hashOf(array));
   return {};
}

Status setExplicit(Measure &measure)
{
   const std::int32_t side = measure.quick() ? 64 : 256;
   CellArray array;
   measure.time(1, [&] {
      RandomCells noise;
      array = CellArray();
      for (std::int32_t x = 0; x < side; ++x)
         for (std::int32_t y = 0; y < side; ++y)
            for (std::int32_t z = 0; z < side; ++z)
               array.set({x, y, z}, noise.next());
   });
   measure.did(static_cast<double>(array.count()), "cells");
   measure.result(hashOf(array));
   return {};
}

template<int Exponent>
Status editAndUndo(Measure &measure)
{
   CellArray array = randomBlock(std::pow(10.0, measure.quick() ? std::min(Exponent, 6) : Exponent));
   const std::int32_t side = array.bounds().max.x + 1;
   constexpr int kEdits = 1000;
   measure.time(9, [&] {
      std::mt19937 random(7);
      const auto coordinate = [&] {
         return static_cast<std::int32_t>(random() % static_cast<unsigned>(side));
      };
      for (int n = 0; n < kEdits; ++n) {
         const CellArray before = array;
         array.set({coordinate(), coordinate(), coordinate()}, {7, 0, 0});
         array = before;
      }
   });
   measure.did(kEdits, "edits");
   measure.result(hashOf(array));
   return {};
}

Model billionCells()
{
   Model model = emptyModel();
   Definition block;
   block.id = "level0";
   block.body.cells.fill({{0, 0, 0}, {9, 9, 9}}, {1, 0, 0});
   DefinitionId inner = *model.setDefinition(std::move(block));
   std::int32_t side = 10;
   for (int level = 1; level <= 2; ++level, side *= 10) {
      Definition next;
      next.id = "level" + std::to_string(level);
      for (std::int32_t k = 0; k < 1000; ++k)
         next.body.instances.insert({inner, Index{k / 100, k / 10 % 10, k % 10} * side, 0});
      inner = *model.setDefinition(std::move(next));
   }
   model.root.instances.insert({inner, {0, 0, 0}, 0});
   return model;
}

Status openBillion(Measure &measure)
{
   const auto lattice = cubeLattice(measure);
   if (!lattice)
      return lattice.error();
   measure.time(5, [&] {
      Hasher hasher;
      const Hierarchy hierarchy(*lattice, billionCells());
      hasher.add(hierarchy.cells());
      hasher.add(hierarchy.bounds().max.x);
      hasher.add(hierarchy.mass().mass);
      const auto hit = hierarchy.hit((*lattice)->position({-5, 500, 500}), Vec3::UnitX(), 1e3);
      hasher.add(hit ? hit->found.index.x : -1);
      measure.result(hasher.finish());
   });
   measure.did(1e9, "cells");
   return {};
}

/// A 256^3 solid, or only its surface two cells thick.
Model block256(bool hollow)
{
   Model model = emptyModel();
   model.root.cells.fill({{-128, -128, -128}, {127, 127, 127}}, {1, 0, 0});
   if (hollow)
      model.root.cells.fill({{-126, -126, -126}, {125, 125, 125}}, Cell());
   return model;
}

template<bool Hollow>
Status pick(Measure &measure)
{
   const auto lattice = cubeLattice(measure);
   if (!lattice)
      return lattice.error();
   const Hierarchy hierarchy(*lattice, block256(Hollow));
   const int rays = measure.quick() ? 1000 : 100000;
   const double size = (*lattice)->spec().pitch * 256;
   measure.time(5, [&] {
      Hasher hasher;
      std::mt19937 random(5);
      const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
      std::uint64_t hits = 0;
      for (int n = 0; n < rays; ++n) {
         // From a sphere around the block to anywhere in a ball somewhat larger than it: hits, grazes and
         // misses.
         const Vec3 from = 2 * size * Vec3(uniform(), uniform(), uniform()).normalized();
         const Vec3 to = 1.2 * size * Vec3(uniform(), uniform(), uniform());
         const auto hit = hierarchy.hit(from, (to - from).normalized(), 10 * size);
         if (hit) {
            ++hits;
            hasher.add(hit->found.index.x);
            hasher.add(hit->face);
         }
      }
      hasher.add(hits);
      measure.result(hasher.finish());
   });
   measure.did(rays, "rays");
   return {};
}

Status visitAll(Measure &measure)
{
   const CellArray array = randomBlock(measure.quick() ? 1e5 : 1e7);
   std::uint64_t sum = 0;
   measure.time(5, [&] {
      sum = 0;
      array.visit([&](Index i, Cell cell) {
         sum += static_cast<std::uint64_t>(i.x) * cell.material;
         return true;
      });
   });
   measure.did(static_cast<double>(array.count()), "cells");
   Hasher hasher;
   hasher.add(sum);
   measure.result(hasher.finish());
   return {};
}

constexpr Benchmark kCellBenchmarks[] = {
    {"fill-256", "fill a box of 256^3 cells with one material", fill256},
    {"fill-100m", "10^8 explicit cells of four random materials, in slabs", fillExplicit},
    {"set-16m", "16.8 million cells of four random materials, one by one", setExplicit},
    {"edit-1e3", "an edit and its undo in 10^3 cells", editAndUndo<3>},
    {"edit-1e6", "an edit and its undo in 10^6 cells", editAndUndo<6>},
    {"edit-1e8", "an edit and its undo in 10^8 cells", editAndUndo<8>},
    {"open-billion", "10^9 cells of nested composites: build, open, count, weigh, pick", openBillion},
    {"pick-solid", "rays at a solid of 256^3 cells", pick<false>},
    {"pick-hollow", "rays at a hollow box of 256^3 cells", pick<true>},
    {"visit", "walk over 10^7 explicit cells", visitAll},
};

} // namespace

std::span<const Benchmark> cellBenchmarks() { return kCellBenchmarks; }

} // namespace diatom::cli
