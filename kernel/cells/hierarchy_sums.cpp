// Sums and extents over the cells of one array: moments by material, bounds after a placement.
#include "cells/hierarchy_summary.h"
#include "cells/tree.h"

#include <algorithm>

namespace diatom::detail {

namespace {

/// How many of the numbers low..high are `residue` modulo `period`, and their sum.
struct Progression
{
   double count = 0, sum = 0;
};

Progression progression(std::int32_t low, std::int32_t high, int residue, int period)
{
   const std::int64_t first = std::int64_t{low} + floorMod(residue - floorMod(low, period), period);
   if (first > high)
      return {};
   const std::int64_t n = (high - first) / period + 1;
   return {static_cast<double>(n),
           static_cast<double>(n) *
               (static_cast<double>(first) + 0.5 * static_cast<double>(period) * static_cast<double>(n - 1))};
}

/// Adds cells by material and site: count and sum of indices, turned into moments at the end.
class MomentSums
{
public:
   explicit MomentSums(const Placing &placing) : m_placing(placing), m_sites(placing.lattice().sites()) {}

   void addBrick(const Brick &brick, Coord origin)
   {
      struct Sum
      {
         std::int32_t n = 0, x = 0, y = 0, z = 0; // of brick coordinates: 4096 x 15 at most
      };
      const auto period = m_placing.lattice().period();
      const Index corner = unbiased(origin);
      std::array<std::uint32_t, kBrickCells> cells;
      brick.decode(cells.data());
      std::vector<MaterialIndex> materials;
      std::vector<Sum> sums;
      std::size_t slot = 0;
      for (std::int32_t x = 0; x < 16; ++x)
         for (std::int32_t y = 0; y < 16; ++y) {
            const int rowSite = m_placing.lattice().site({corner.x + x, corner.y + y, corner.z});
            int siteZ = rowSite % period[2];
            const int rowBase = rowSite - siteZ;
            for (std::int32_t z = 0; z < 16; ++z, siteZ = siteZ + 1 == period[2] ? 0 : siteZ + 1) {
               const auto material =
                   static_cast<MaterialIndex>(cells[static_cast<std::size_t>(x << 8 | y << 4 | z)]);
               if (material == 0)
                  continue;
               if (materials.empty() || materials[slot] != material) {
                  slot = static_cast<std::size_t>(std::find(materials.begin(), materials.end(), material) -
                                                  materials.begin());
                  if (slot == materials.size()) {
                     materials.push_back(material);
                     sums.resize(sums.size() + static_cast<std::size_t>(m_sites));
                  }
               }
               Sum &sum =
                   sums[slot * static_cast<std::size_t>(m_sites) + static_cast<std::size_t>(rowBase + siteZ)];
               ++sum.n;
               sum.x += x;
               sum.y += y;
               sum.z += z;
            }
         }
      for (std::size_t m = 0; m < materials.size(); ++m)
         for (int s = 0; s < m_sites; ++s) {
            const Sum &sum = sums[m * static_cast<std::size_t>(m_sites) + static_cast<std::size_t>(s)];
            add(materials[m], s, sum.n,
                Vec3(sum.x, sum.y, sum.z) + double(sum.n) * Vec3(corner.x, corner.y, corner.z));
         }
   }
   void addBox(const Box &box, MaterialIndex material)
   {
      const auto period = m_placing.lattice().period();
      for (int s = 0; s < m_sites; ++s) {
         const Progression x = progression(box.min.x, box.max.x, s / (period[1] * period[2]), period[0]);
         const Progression y = progression(box.min.y, box.max.y, s / period[2] % period[1], period[1]);
         const Progression z = progression(box.min.z, box.max.z, s % period[2], period[2]);
         add(material, s, x.count * y.count * z.count,
             Vec3(x.sum * y.count * z.count, x.count * y.sum * z.count, x.count * y.count * z.sum));
      }
   }
   std::vector<Moment> take() { return std::move(m_moments); }

private:
   void add(MaterialIndex material, int site, double n, const Vec3 &indexSum)
   {
      if (n == 0)
         return;
      if (m_moments.size() <= material)
         m_moments.resize(material + std::size_t{1});
      const double volume = m_placing.volume(site);
      Moment &moment = m_moments[material];
      moment.volume += n * volume;
      moment.first += volume * m_placing.displacement(site, n, indexSum);
   }

   const Placing &m_placing;
   int m_sites;
   std::vector<Moment> m_moments;
};

/// Extends `box` by where every cell of the uniform block lands. Over a residue class the landing is affine,
/// so each class reaches its extremes in the corners of the block.
void extendByBlock(Box &box, const Box &block, const Placement &p, const Placing &placing)
{
   const auto period = placing.lattice().period();
   const auto ends = [](std::int32_t low, std::int32_t high, int n) {
      std::vector<std::int32_t> at;
      for (std::int32_t v = low; v <= high; ++v) {
         if (v == low + n && high - n > v)
            v = high - n + 1;
         at.push_back(v);
      }
      return at;
   };
   for (const std::int32_t x : ends(block.min.x, block.max.x, period[0]))
      for (const std::int32_t y : ends(block.min.y, block.max.y, period[1]))
         for (const std::int32_t z : ends(block.min.z, block.max.z, period[2]))
            box.extend(placing.place(p, {x, y, z}));
}

bool within(const Box &inner, const Box &outer)
{
   return !outer.empty() && outer.contains(inner.min) && outer.contains(inner.max);
}

void extendByContent(Box &box, const Block &block, Coord origin, int level, const Placement &p,
                     const Placing &placing)
{
   if (block.empty() || within(placing.placeBox(p, contentBounds(block, origin, level)), box))
      return;
   if (!block.isNode()) {
      extendByBlock(box, blockBox(origin, level), p, placing);
   } else if (level == 0) {
      const Brick &brick = asBrick(*block.node());
      for (unsigned c = 0; c < kBrickCells; ++c)
         if (brick.at(c) != 0)
            box.extend(placing.place(
                p, unbiased({origin.x + (c >> 8), origin.y + (c >> 4 & 15), origin.z + (c & 15)})));
   } else {
      const Inner &inner = asInner(*block.node());
      // Outside in: after the first and last children most of the others lie within.
      for (unsigned k = 0; k < 64; ++k) {
         const unsigned c = k % 2 == 0 ? k / 2 : 63 - k / 2;
         extendByContent(box, inner.children[c], childOrigin(origin, level, c), level - 1, p, placing);
      }
   }
}

} // namespace

std::vector<Moment> cellMoments(const CellArray &cells, const Placing &placing)
{
   MomentSums sums(placing);
   if (const RootView root = viewRoot(cells.root()); root.node)
      walk(
          cells.root(), root.origin, root.node->level, rangeOf(cells.bounds()),
          [&](const Brick &brick, Coord origin) {
             sums.addBrick(brick, origin);
             return true;
          },
          [&](std::uint32_t value, Coord origin, int level) {
             sums.addBox(blockBox(origin, level), Cell::unpacked(value).material);
             return true;
          });
   std::vector<Moment> moments = sums.take();
   const auto counts = cells.countByMaterial(); // exact, where sums of doubles would round
   for (std::size_t m = 0; m < moments.size(); ++m)
      moments[m].count = counts[m];
   return moments;
}

Box placedBounds(const CellArray &cells, const Placement &placement, const Placing &placing)
{
   if (placing.isTight(placement))
      return placing.placeBox(placement, cells.bounds());
   Box box;
   if (const RootView root = viewRoot(cells.root()); root.node)
      extendByContent(box, cells.root(), root.origin, root.node->level, placement, placing);
   return box;
}

} // namespace diatom::detail
