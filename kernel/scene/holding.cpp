#include "scene/holding.h"

#include "core/text.h"
#include "scene/where.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

constexpr std::size_t kMostCells = 20'000'000; // as many as can be simulated at once

std::uint8_t bitOf(int freedom) { return static_cast<std::uint8_t>(1U << static_cast<unsigned>(freedom)); }

/// A cell whose freedom in question follows a curve of the set-up, or is held.
struct Taken
{
   Index cell;
   const Drive *drive; // null: held
};

/// Sorted by cell, drives in their order and before supports.
std::vector<Taken> takenCells(const Hierarchy &hierarchy, const Setup &setup, int freedom)
{
   std::vector<Taken> taken;
   for (const Drive &drive : setup.drives)
      if (drive.freedom == freedom)
         for (const Index cell : someCells(hierarchy, drive.where, kMostCells))
            taken.push_back({cell, &drive});
   if (taken.empty())
      return taken; // nothing driven, so that no support can be in its way
   for (const Support &support : setup.supports)
      if ((support.fixed & bitOf(freedom)) != 0)
         for (const Index cell : someCells(hierarchy, support.where, kMostCells))
            taken.push_back({cell, nullptr});
   std::stable_sort(taken.begin(), taken.end(),
                    [](const Taken &a, const Taken &b) { return a.cell < b.cell; });
   return taken;
}

Problem conflict(const Taken &first, const Taken &second, int freedom)
{
   const char *name = kFreedoms[static_cast<std::size_t>(freedom)];
   if (!second.drive)
      return {Problem::Severity::error,
              "held-and-driven",
              fmt::format("cell {} is both held and driven in {}: take {} out of its support or remove the "
                          "drive on {}",
                          indexText(first.cell), name, name, whereText(first.drive->where)),
              {first.cell}};
   return {Problem::Severity::error,
           "driven-twice",
           fmt::format("cell {} is driven in {} along two different curves, by the drives on {} and {}: "
                       "remove one of them",
                       indexText(first.cell), name, whereText(first.drive->where),
                       whereText(second.drive->where)),
           {first.cell}};
}

} // namespace

Holding::Holding(const Hierarchy &hierarchy, const Setup &setup)
{
   const auto add = [&](const Where &where, std::uint8_t mask) {
      for (const Index cell : someCells(hierarchy, where, kMostCells))
         m_cells.emplace_back(cell, mask);
   };
   for (const Support &support : setup.supports)
      add(support.where, support.fixed);
   for (const Drive &drive : setup.drives)
      add(drive.where, bitOf(drive.freedom));
   std::sort(m_cells.begin(), m_cells.end());
   std::size_t kept = 0;
   for (const auto &[cell, mask] : m_cells) {
      if (kept > 0 && m_cells[kept - 1].first == cell)
         m_cells[kept - 1].second |= mask;
      else
         m_cells[kept++] = {cell, mask};
   }
   m_cells.resize(kept);
}

std::uint8_t Holding::freedoms(Index cell) const
{
   const auto found = std::lower_bound(m_cells.begin(), m_cells.end(), std::pair(cell, std::uint8_t{0}));
   return found != m_cells.end() && found->first == cell ? found->second : std::uint8_t{0};
}

std::string curveFault(const Curve &curve)
{
   if (curve.empty())
      return "has no points";
   for (std::size_t i = 0; i < curve.size(); ++i) {
      if (!std::isfinite(curve[i].time) || !std::isfinite(curve[i].value))
         return "has a point that is not a number";
      if (i > 0 && !(curve[i].time > curve[i - 1].time))
         return fmt::format("has times that do not ascend: {} s follows {} s", numberText(curve[i].time),
                            numberText(curve[i - 1].time));
   }
   return {};
}

void findConflicts(std::vector<Problem> &problems, const Hierarchy &hierarchy, const Setup &setup)
{
   for (int freedom = 0; freedom < static_cast<int>(kFreedoms.size()); ++freedom) {
      const auto taken = takenCells(hierarchy, setup, freedom);
      const auto clash = std::adjacent_find(taken.begin(), taken.end(), [](const Taken &a, const Taken &b) {
         if (a.cell != b.cell || !a.drive)
            return false;
         return !b.drive || a.drive->curve != b.drive->curve;
      });
      if (clash != taken.end())
         problems.push_back(conflict(*clash, *std::next(clash), freedom));
   }
}

} // namespace diatom
