#include "scene/problems.h"

#include "scene/cell_list.h"
#include "scene/fields.h"
#include "scene/holding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>

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
void findMissing(std::vector<Problem> &problems, const char *what, const Hierarchy &hierarchy,
                 const std::vector<Item> &items)
{
   std::vector<Index> missing;
   for (const Item &item : items) {
      if (anyCell(hierarchy, item.where))
         continue;
      if (const auto *cell = std::get_if<Index>(&item.where))
         missing.push_back(*cell);
      else
         problems.push_back(
             {Problem::Severity::error,
              fmt::format("{}-without-cell", what),
              fmt::format("a {} is set on {}, where the design has no cell; place cells there or "
                          "remove the {}",
                          what, whereText(item.where), what),
              {}});
   }
   addMissing(problems, what, missing);
}

bool finite(std::initializer_list<std::array<double, 3>> vectors)
{
   for (const auto &vector : vectors)
      for (const double value : vector)
         if (!std::isfinite(value))
            return false;
   return true;
}

void findNotNumbers(std::vector<Problem> &problems, const Setup &setup)
{
   const auto report = [&](const char *what, const Where &where) {
      problems.push_back(
          {Problem::Severity::error,
           "not-a-number",
           fmt::format("the {} on {} has a value that is not a number; set it anew", what, whereText(where)),
           {}});
   };
   for (const Load &load : setup.loads)
      if (!finite({load.force, load.moment}))
         report("load", load.where);
   for (const Start &start : setup.starts)
      if (!finite({start.displacement, start.turn, start.velocity, start.spin,
                   start.about.value_or(std::array<double, 3>{})}))
         report("start", start.where);
}

void findBadCurves(std::vector<Problem> &problems, const Setup &setup)
{
   for (const Drive &drive : setup.drives) {
      const std::string fault = drive.freedom < 0 || drive.freedom >= static_cast<int>(kFreedoms.size())
                                    ? "names no degree of freedom"
                                    : curveFault(drive.curve);
      if (!fault.empty())
         problems.push_back({Problem::Severity::error,
                             "bad-curve",
                             fmt::format("the drive on {} {}; set it anew", whereText(drive.where), fault),
                             {}});
   }
}

} // namespace

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
   findMissing(problems, "support", hierarchy, setup.supports);
   findMissing(problems, "drive", hierarchy, setup.drives);
   findMissing(problems, "load", hierarchy, setup.loads);
   findMissing(problems, "start", hierarchy, setup.starts);
   findMissing(problems, "field", hierarchy, setup.fields);
   std::vector<Index> missing;
   for (const Source &source : setup.sources)
      if (!inRange(source.cell) || hierarchy.at(source.cell).empty())
         missing.push_back(source.cell);
   addMissing(problems, "source", missing);
   findNotNumbers(problems, setup);
   findBadCurves(problems, setup);
   findBadFields(problems, setup);
   if (problems.empty()) // what is driven twice can be told only of sound entries
      findConflicts(problems, hierarchy, setup);
   return problems;
}

std::vector<Problem> findFloatingBodies(const Hierarchy &hierarchy, const Bodies &bodies, const Setup &setup)
{
   std::vector<Problem> problems;
   if (setup.gravity == std::array<double, 3>{} || setup.ground.present)
      return problems;
   const Holding holding(hierarchy, setup);
   for (const auto &body : bodies) {
      const bool held = std::any_of(body.begin(), body.end(),
                                    [&](Index cell) { return (holding.freedoms(cell) & 7) != 0; });
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
