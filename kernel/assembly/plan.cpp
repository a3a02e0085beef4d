// The order of assembly. What can ever be held is found first; then parts go in rank order (layer by layer,
// row by row), each waiting for those beneath it that can still come. A part needs support from its own
// height or below, so for parts that lie within one layer this places everything that any order could place.
#include "assembly/plan.h"

#include "assembly/columns.h"
#include "assembly/part_graph.h"
#include "core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>

namespace diatom {

namespace {

constexpr std::int64_t kPollEvery = 4096;

std::string indexText(Index i) { return fmt::format("({}, {}, {})", i.x, i.y, i.z); }

class Planner
{
public:
   Planner(const Lattice &lattice, const Decomposition &parts, const Job &job)
       : m_job(job), m_graph(lattice, parts), m_columns(lattice, m_graph.indices()),
         m_state(m_graph.parts(), State::pending), m_supported(m_graph.parts(), 0),
         m_waits(m_graph.parts(), 0)
   {
      m_top.assign(static_cast<std::size_t>(m_columns.count()), -std::numeric_limits<double>::infinity());
   }

   Result<AssemblyPlan> run()
   {
      findHoldable();
      findWaits();
      placeAll();
      if (m_job.cancelled())
         return Error{ErrorCode::cancelled, "planning the assembly was cancelled"};
      explain();
      return std::move(m_plan);
   }

private:
   enum class State : std::uint8_t { pending, placed, blocked };
   using Queue = std::priority_queue<std::int32_t, std::vector<std::int32_t>, std::greater<>>; // of ranks

   static std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }
   std::int32_t count() const { return static_cast<std::int32_t>(m_graph.parts()); }

   /// Everything that is held once all else is there, reach not considered.
   void findHoldable()
   {
      m_holdable.assign(m_graph.parts(), 0);
      std::vector<std::int32_t> open;
      const auto reach = [&](std::int32_t part) {
         if (m_holdable[at(part)] == 0) {
            m_holdable[at(part)] = 1;
            open.push_back(part);
         }
      };
      for (std::int32_t part = 0; part < count(); ++part)
         if (m_graph.onPlate(part))
            reach(part);
      while (!open.empty() && !m_job.cancelled()) {
         const std::int32_t part = open.back();
         open.pop_back();
         m_graph.held(part, reach);
      }
      m_total = std::count(m_holdable.begin(), m_holdable.end(), 1);
      m_job.progress(0.2, "planning the assembly");
   }

   /// Each part waits for the next holdable part beneath each of its cells; that one waits for those further
   /// down.
   void findWaits()
   {
      std::vector<std::vector<std::int32_t>> cellsIn(at(m_columns.count()));
      for (std::int32_t cell = 0; cell < static_cast<std::int32_t>(m_graph.cells()); ++cell)
         cellsIn[at(m_columns.of(at(cell)))].push_back(cell);
      const auto lower = [&](std::int32_t a, std::int32_t b) {
         return m_graph.height(a) < m_graph.height(b);
      };
      for (auto &cells : cellsIn)
         std::stable_sort(cells.begin(), cells.end(), lower);

      std::vector<std::pair<std::int32_t, std::int32_t>> edges; // lower part, waiting part
      for (std::int32_t cell = 0; cell < static_cast<std::int32_t>(m_graph.cells()); ++cell)
         for (const std::int32_t column : m_columns.overlapping(m_columns.of(at(cell))))
            waitFor(cellsIn[at(column)], cell, edges);
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

      m_waitStart.assign(m_graph.parts() + 1, 0);
      for (const auto &[below, waiting] : edges) {
         ++m_waitStart[at(below) + 1];
         ++m_waits[at(waiting)];
         m_waiting.push_back(waiting);
      }
      std::partial_sum(m_waitStart.begin(), m_waitStart.end(), m_waitStart.begin());
      m_job.progress(0.4, "planning the assembly");
   }

   void waitFor(const std::vector<std::int32_t> &column, std::int32_t cell,
                std::vector<std::pair<std::int32_t, std::int32_t>> &edges) const
   {
      const double beneath = m_graph.height(cell) - m_graph.tolerance();
      auto end = std::lower_bound(column.begin(), column.end(), beneath,
                                  [&](std::int32_t c, double height) { return m_graph.height(c) < height; });
      bool found = false;
      while (!found && end != column.begin())
         for (const std::int32_t below : m_graph.partsOf(*--end)) {
            if (m_holdable[at(below)] == 0)
               continue;
            found = true;
            for (const std::int32_t part : m_graph.partsOf(cell))
               if (part != below)
                  edges.emplace_back(below, part);
         }
   }

   void placeAll()
   {
      for (std::int32_t part = 0; part < count(); ++part)
         if (m_graph.onPlate(part))
            support(part);
      for (std::int64_t settled = 0;; ++settled) {
         if (settled % kPollEvery == 0) {
            if (m_job.cancelled())
               return;
            m_job.progress(0.4 + 0.6 * static_cast<double>(settled) / static_cast<double>(m_total + 1),
                           "planning the assembly");
         }
         // When all that is held waits for something beneath that will not come (parts of several layers can
         // hold each other up in a ring), the first in line goes ahead.
         std::int32_t part = next(m_ready);
         if (part < 0)
            part = next(m_held);
         if (part < 0)
            return;
         settle(part);
      }
   }

   std::int32_t next(Queue &queue)
   {
      while (!queue.empty()) {
         const std::int32_t part = m_graph.partAt(queue.top());
         queue.pop();
         if (m_state[at(part)] == State::pending)
            return part;
      }
      return -1;
   }

   void support(std::int32_t part)
   {
      if (m_supported[at(part)] != 0)
         return;
      m_supported[at(part)] = 1;
      (m_waits[at(part)] == 0 ? m_ready : m_held).push(m_graph.rank(part));
   }

   void settle(std::int32_t part)
   {
      const bool reachable = obstacle(part) < 0;
      m_state[at(part)] = reachable ? State::placed : State::blocked;
      if (reachable) {
         m_plan.order.push_back(part);
         for (const std::int32_t cell : m_graph.cellsOf(part)) {
            double &top = m_top[at(m_columns.of(at(cell)))];
            top = std::max(top, m_graph.height(cell));
         }
         m_graph.held(part, [this](std::int32_t other) { support(other); });
      }
      for (std::int64_t i = m_waitStart[at(part)]; i < m_waitStart[at(part) + 1]; ++i) {
         const std::int32_t waiting = m_waiting[static_cast<std::size_t>(i)];
         if (--m_waits[at(waiting)] == 0 && m_supported[at(waiting)] != 0)
            m_ready.push(m_graph.rank(waiting));
      }
   }

   /// A cell of the part above which something was placed; -1 when the way down is free.
   std::int32_t obstacle(std::int32_t part) const
   {
      for (const std::int32_t cell : m_graph.cellsOf(part))
         for (const std::int32_t column : m_columns.overlapping(m_columns.of(at(cell))))
            if (m_top[at(column)] > m_graph.height(cell) + m_graph.tolerance())
               return cell;
      return -1;
   }

   /// One problem for each group of joined parts that were left out for the same reason.
   void explain()
   {
      std::vector<std::uint8_t> told(m_graph.parts(), 0);
      for (std::int32_t rank = 0; rank < count(); ++rank) {
         const std::int32_t first = m_graph.partAt(rank);
         const State state = m_state[at(first)];
         if (state == State::placed || told[at(first)] != 0)
            continue;
         std::vector<std::int32_t> group{first};
         told[at(first)] = 1;
         for (std::size_t i = 0; i < group.size(); ++i)
            m_graph.joined(group[i], [&](std::int32_t other) {
               if (m_state[at(other)] == state && told[at(other)] == 0) {
                  told[at(other)] = 1;
                  group.push_back(other);
               }
            });
         m_plan.problems.push_back(problem(group, state));
      }
   }

   Problem problem(const std::vector<std::int32_t> &group, State state) const
   {
      const bool blocked = state == State::blocked;
      Problem result{Problem::Severity::error, blocked ? "unreachable-part" : "unsupported-part", {}, {}};
      for (const std::int32_t part : group)
         for (const std::int32_t cell : m_graph.cellsOf(part))
            result.cells.push_back(m_graph.index(cell));
      const Index where = result.cells.front();
      std::sort(result.cells.begin(), result.cells.end());
      result.cells.erase(std::unique(result.cells.begin(), result.cells.end()), result.cells.end());
      const std::string which = group.size() == 1
                                    ? "the part at " + indexText(where)
                                    : fmt::format("the {} parts around {}", group.size(), indexText(where));
      result.text =
          blocked
              ? fmt::format("nothing can reach {} from above once its support is there: turn the design",
                            which)
              : fmt::format("nothing holds {} from below or beside: add a support or turn the design", which);
      return result;
   }

   const Job &m_job;
   PartGraph m_graph;
   Columns m_columns;
   std::vector<State> m_state;
   std::vector<std::uint8_t> m_holdable, m_supported;
   std::vector<std::int32_t> m_waits;     // parts still to come beneath each
   std::vector<std::int64_t> m_waitStart; // parts + 1, into m_waiting
   std::vector<std::int32_t> m_waiting;
   std::vector<double> m_top; // highest centre placed in each column
   std::int64_t m_total = 0;
   Queue m_ready, m_held;
   AssemblyPlan m_plan;
};

} // namespace

Result<AssemblyPlan> planAssembly(const Hierarchy &hierarchy, const Decomposition &parts, const Job &job)
{
   if (parts.parts.size() > std::numeric_limits<std::int32_t>::max())
      return Error{ErrorCode::unsupported,
                   fmt::format("the design has {} parts; an assembly of more than 2^31 cannot be planned",
                               parts.parts.size())};
   for (const Part &part : parts.parts)
      DIATOM_CHECK(part.cells > 0); // PartMaker refuses parts that cover nothing
   auto plan = Planner(hierarchy.lattice(), parts, job).run();
   if (plan.ok() && !parts.left.empty())
      plan->problems.push_back(
          {Problem::Severity::warning, "uncovered-cells",
           fmt::format("{} cells, the first at {}, are not made by any part: choose other parts",
                       parts.left.size(), indexText(parts.left.front())),
           parts.left});
   return plan;
}

} // namespace diatom
