// The cell array's face: indices and cells in, blocks of the tree out.
#include "cells/cell_array.h"

#include "cells/tree.h"
#include "core/check.h"

#include <algorithm>

namespace diatom {

using namespace detail;

namespace {

constexpr Box kEverything{{-kIndexLimit, -kIndexLimit, -kIndexLimit},
                          {kIndexLimit, kIndexLimit, kIndexLimit}};

Box clipped(const Box &a, const Box &b)
{
   return {{std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y), std::max(a.min.z, b.min.z)},
           {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y), std::min(a.max.z, b.max.z)}};
}

/// The brick or uniform value around a coordinate, and the level it was found at.
struct Place
{
   const Brick *brick = nullptr;
   std::uint32_t value = 0;
   int level = 0;
};

Place locate(const Block &root, Coord u)
{
   const Node *node = root.node();
   int level = node->level;
   for (;;) {
      const Block &child = asInner(*node).children[childNumber(u, level)];
      --level;
      if (!child.isNode())
         return {nullptr, child.value(), level};
      node = child.node();
      if (level == 0)
         return {&asBrick(*node), 0, 0};
   }
}

/// Visits the cells of a block that lie in `box`.
template<typename Value>
bool visitCells(const Box &box, Value value, const std::function<bool(Index, Cell)> &visit)
{
   for (std::int32_t x = box.min.x; x <= box.max.x; ++x)
      for (std::int32_t y = box.min.y; y <= box.max.y; ++y)
         for (std::int32_t z = box.min.z; z <= box.max.z; ++z) {
            const std::uint32_t v = value(Index{x, y, z});
            if (v != 0 && !visit({x, y, z}, Cell::unpacked(v)))
               return false;
         }
   return true;
}

/// Calls visit for runs of equal cells along z.
void visitRuns(const Box &box, const Brick &brick, const std::function<bool(const Box &, Cell)> &visit,
               bool &on)
{
   const auto value = [&](Index i) { return brick.at(brickCell(biased(i))); };
   for (std::int32_t x = box.min.x; x <= box.max.x; ++x)
      for (std::int32_t y = box.min.y; y <= box.max.y; ++y)
         for (std::int32_t z = box.min.z; z <= box.max.z && on;) {
            const std::uint32_t v = value({x, y, z});
            std::int32_t end = z;
            while (end < box.max.z && value({x, y, end + 1}) == v)
               ++end;
            if (v != 0)
               on = visit({{x, y, z}, {x, y, end}}, Cell::unpacked(v));
            z = end + 1;
         }
}

} // namespace

Cell CellArray::at(Index i) const
{
   if (m_root.empty() || !m_root.node()->bounds.contains(i))
      return {};
   const Coord u = biased(i);
   const Place place = locate(m_root, u);
   return Cell::unpacked(place.brick ? place.brick->at(brickCell(u)) : place.value);
}

bool CellArray::empty() const { return m_root.empty(); }

std::uint64_t CellArray::count() const { return m_root.empty() ? 0 : m_root.node()->count; }

Box CellArray::bounds() const { return m_root.empty() ? Box() : m_root.node()->bounds; }

std::vector<std::uint64_t> CellArray::countByMaterial() const
{
   std::vector<std::uint64_t> counts(1);
   const auto add = [&](std::uint32_t value, std::uint64_t n) {
      const MaterialIndex material = Cell::unpacked(value).material;
      if (material == 0 || n == 0)
         return;
      if (counts.size() <= material)
         counts.resize(material + std::size_t{1});
      counts[material] += n;
   };
   if (const RootView root = viewRoot(m_root); root.node)
      walk(
          m_root, root.origin, root.node->level, rangeOf(bounds()),
          [&](const Brick &brick, Coord) {
             for (const Brick::Entry &entry : brick.palette)
                add(entry.value, entry.uses);
             if (brick.widthLog == Brick::kRaw)
                for (unsigned c = 0; c < kBrickCells; ++c)
                   add(brick.at(c), 1);
             return true;
          },
          [&](std::uint32_t value, Coord, int level) {
             add(value, blockCells(level));
             return true;
          });
   return counts;
}

void CellArray::set(Index i, Cell cell)
{
   // An edit that changes nothing keeps sharing what is shared.
   const std::uint32_t value = cell.empty() ? 0 : cell.packed();
   if (!inRange(i) || (m_root.isNode() && m_root.node()->references.load(std::memory_order_relaxed) != 1 &&
                       at(i) == Cell::unpacked(value)))
      return;
   setCell(m_root, i, value);
}

void CellArray::fill(const Box &box, Cell cell)
{
   const Box part = clipped(box, cell.empty() ? bounds() : kEverything);
   if (!part.empty())
      fillRange(m_root, rangeOf(part), cell.empty() ? 0 : cell.packed());
}

void CellArray::write(const Box &box, std::span<const Cell> cells)
{
   const bool fits = !box.empty() && inRange(box.min) && inRange(box.max);
   DIATOM_CHECK(fits && box.volume() == static_cast<double>(cells.size()));
   writeRange(m_root, rangeOf(box), cells.data());
}

void CellArray::clear() { m_root = Block(); }

void CellArray::replaceMaterial(MaterialIndex from, MaterialIndex to)
{
   if (from == 0 || from == to)
      return;
   mapValues(m_root, [from, to](std::uint32_t value) {
      Cell cell = Cell::unpacked(value);
      if (cell.material != from)
         return value;
      cell.material = to;
      return to == 0 ? 0 : cell.packed();
   });
}

bool CellArray::visit(const Box &box, const std::function<bool(Index, Cell)> &visit) const
{
   const RootView root = viewRoot(m_root);
   const Box part = clipped(box, bounds());
   if (!root.node || part.empty())
      return true;
   return walk(
       m_root, root.origin, root.node->level, rangeOf(part),
       [&](const Brick &brick, Coord) {
          return visitCells(
              clipped(part, brick.bounds), [&](Index i) { return brick.at(brickCell(biased(i))); }, visit);
       },
       [&](std::uint32_t value, Coord origin, int level) {
          return visitCells(
              clipped(part, blockBox(origin, level)), [value](Index) { return value; }, visit);
       });
}

bool CellArray::visit(const std::function<bool(Index, Cell)> &visit) const
{
   return this->visit(bounds(), visit);
}

void CellArray::visitBlocks(const Box &box, const std::function<bool(const Box &, Cell)> &visit) const
{
   const RootView root = viewRoot(m_root);
   const Box part = clipped(box, bounds());
   if (!root.node || part.empty())
      return;
   walk(
       m_root, root.origin, root.node->level, rangeOf(part),
       [&](const Brick &brick, Coord) {
          bool on = true;
          visitRuns(clipped(part, brick.bounds), brick, visit, on);
          return on;
       },
       [&](std::uint32_t value, Coord origin, int level) {
          return visit(clipped(part, blockBox(origin, level)), Cell::unpacked(value));
       });
}

bool operator==(const CellArray &a, const CellArray &b) { return equalBlocks(a.m_root, b.m_root); }

void CellArray::hash(Hasher &hasher) const
{
   const Box box = bounds();
   for (const std::int32_t v : {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z})
      hasher.add(v);
   const Hash content = m_root.empty() ? Hash() : nodeHash(*m_root.node());
   hasher.add(content.high);
   hasher.add(content.low);
}

std::uint64_t CellArray::bytes() const { return blockBytes(m_root); }

Cell CellArray::Reader::at(Index i)
{
   const Coord u = biased(i);
   if (!m_known || !sameBlock(u, biased(m_inside), m_level)) {
      const Block &root = m_array->m_root;
      if (root.empty() || !root.node()->bounds.contains(i))
         return {};
      const Place place = locate(root, u);
      m_brick = place.brick;
      m_value = place.value;
      m_level = place.level;
      m_inside = i;
      m_known = true;
   }
   return Cell::unpacked(m_brick ? m_brick->at(brickCell(u)) : m_value);
}

} // namespace diatom
