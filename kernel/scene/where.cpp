#include "scene/where.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

bool cornerInOrder(const Box &box) { return !box.empty() && inRange(box.min) && inRange(box.max); }

} // namespace

std::string indexText(Index cell) { return fmt::format("({}, {}, {})", cell.x, cell.y, cell.z); }

std::string whereText(const Where &where)
{
   if (const auto *cell = std::get_if<Index>(&where))
      return "cell " + indexText(*cell);
   if (const auto *box = std::get_if<Box>(&where))
      return fmt::format("box {} to {}", indexText(box->min), indexText(box->max));
   return "material " + std::get<OfMaterial>(where).id;
}

bool wellFormed(const Where &where)
{
   if (const auto *cell = std::get_if<Index>(&where))
      return inRange(*cell);
   if (const auto *box = std::get_if<Box>(&where))
      return cornerInOrder(*box);
   return !std::get<OfMaterial>(where).id.empty();
}

bool anyCell(const Hierarchy &hierarchy, const Where &where)
{
   if (!wellFormed(where))
      return false;
   if (const auto *of = std::get_if<OfMaterial>(&where)) {
      const MaterialIndex material = hierarchy.model().material(of->id);
      const auto counts = hierarchy.countByMaterial();
      return material != 0 && material < counts.size() && counts[material] > 0;
   }
   return !someCells(hierarchy, where, 1).empty();
}

std::vector<Index> someCells(const Hierarchy &hierarchy, const Where &where, std::size_t most)
{
   std::vector<Index> cells;
   if (!wellFormed(where) || most == 0)
      return cells;
   if (const auto *cell = std::get_if<Index>(&where)) {
      if (!hierarchy.at(*cell).empty())
         cells.push_back(*cell);
      return cells;
   }
   MaterialIndex wanted = 0; // any
   if (const auto *of = std::get_if<OfMaterial>(&where)) {
      if (!anyCell(hierarchy, where))
         return cells;
      wanted = hierarchy.model().material(of->id);
   }
   const auto *box = std::get_if<Box>(&where);
   std::int64_t seen = 0;
   hierarchy.visit(box ? *box : hierarchy.bounds(), [&](Index i, Cell cell) {
      if (wanted == 0 || cell.material == wanted)
         cells.push_back(i);
      return cells.size() < most && (box || ++seen < kMostSearched);
   });
   std::sort(cells.begin(), cells.end());
   return cells;
}

bool before(const Where &a, const Where &b)
{
   if (a.index() != b.index())
      return a.index() < b.index();
   if (const auto *cell = std::get_if<Index>(&a))
      return *cell < std::get<Index>(b);
   if (const auto *box = std::get_if<Box>(&a)) {
      const auto &other = std::get<Box>(b);
      return box->min != other.min ? box->min < other.min : box->max < other.max;
   }
   return std::get<OfMaterial>(a).id < std::get<OfMaterial>(b).id;
}

} // namespace diatom
