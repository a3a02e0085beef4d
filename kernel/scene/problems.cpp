#include "scene/problems.h"

#include "scene/cell_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

namespace diatom {

namespace {

void addMissing(std::vector<Problem> &problems, const char *what, const std::vector<Index> &missing)
{
   if (!missing.empty())
      problems.push_back(
          {Problem::Severity::error, fmt::format("{}-without-cell", what),
           fmt::format("there is no cell where a {} is set: {}; place a cell there or remove the {}", what,
                       indicesText(missing), what),
           missing});
}

template<typename Item>
std::vector<Index> withoutCell(const Hierarchy &hierarchy, const std::vector<Item> &items)
{
   std::vector<Index> missing;
   for (const Item &item : items)
      if (!inRange(item.cell) || hierarchy.at(item.cell).empty())
         missing.push_back(item.cell);
   return missing;
}

} // namespace

std::string indexText(Index cell) { return fmt::format("({}, {}, {})", cell.x, cell.y, cell.z); }

std::string indicesText(const std::vector<Index> &cells)
{
   constexpr std::size_t kShown = 4;
   std::string text;
   for (std::size_t i = 0; i < std::min(cells.size(), kShown); ++i)
      text += (i > 0 ? ", " : "") + indexText(cells[i]);
   if (cells.size() > kShown)
      text += fmt::format(" and {} more", cells.size() - kShown);
   return text;
}

Result<Bodies> findBodies(const Hierarchy &hierarchy, const Job &job, std::int64_t limit)
{
   const auto cells = listCells(hierarchy, {}, limit, job);
   if (!cells)
      return cells.error();
   const auto pairs = joinedPairs(hierarchy.lattice(), *cells, job);
   if (!pairs)
      return pairs.error();
   std::map<std::int32_t, std::vector<Index>> bySmallest;
   const auto label = connectedTo(cells->count(), *pairs);
   for (std::size_t i = 0; i < label.size(); ++i)
      bySmallest[label[i]].push_back(cells->index[i]);
   Bodies bodies;
   for (auto &[smallest, body] : bySmallest)
      bodies.push_back(std::move(body));
   return bodies;
}

std::vector<Problem> findSetupProblems(const Hierarchy &hierarchy, const Setup &setup)
{
   std::vector<Problem> problems;
   addMissing(problems, "support", withoutCell(hierarchy, setup.supports));
   addMissing(problems, "load", withoutCell(hierarchy, setup.loads));
   addMissing(problems, "source", withoutCell(hierarchy, setup.sources));
   std::set<Index> seen;
   std::vector<Index> repeated;
   for (const Support &support : setup.supports)
      if (!seen.insert(support.cell).second)
         repeated.push_back(support.cell);
   if (!repeated.empty())
      problems.push_back(
          {Problem::Severity::error, "repeated-support",
           fmt::format("a cell has more than one support: {}; keep one", indicesText(repeated)), repeated});
   return problems;
}

std::vector<Problem> findFloatingBodies(const Bodies &bodies, const Setup &setup)
{
   std::vector<Problem> problems;
   if (setup.gravity == std::array<double, 3>{} || setup.ground.present)
      return problems;
   for (const auto &body : bodies) {
      const bool held =
          std::any_of(setup.supports.begin(), setup.supports.end(), [&](const Support &support) {
             return (support.fixed & 7) != 0 && std::binary_search(body.begin(), body.end(), support.cell);
          });
      if (!held)
         problems.push_back(
             {Problem::Severity::warning, "floating-body",
              fmt::format("nothing holds the body of {} cells at {}: it will fall for ever; support one "
                          "of its cells, set a ground, or set gravity to zero",
                          body.size(), indexText(body.front())),
              body});
   }
   return problems;
}

} // namespace diatom
