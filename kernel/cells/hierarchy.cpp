// Questions about single cells and sums, answered level by level.
#include "cells/hierarchy.h"

#include "cells/hierarchy_summary.h"

#include <algorithm>

namespace diatom {

using namespace detail;

std::uint64_t Hierarchy::cells() const { return m_root->count; }

std::uint64_t Hierarchy::stored() const
{
   std::uint64_t sum = m_root->stored;
   for (const auto &[id, summary] : m_summaries)
      if (summary)
         sum = sum + summary->stored < sum ? ~std::uint64_t{0} : sum + summary->stored;
   return sum;
}

int Hierarchy::depth() const { return m_root->depth; }

Box Hierarchy::bounds() const { return m_root->bounds; }

std::vector<std::uint64_t> Hierarchy::countByMaterial() const
{
   const auto &moments = m_root->moments(*m_placing);
   std::vector<std::uint64_t> counts(std::max<std::size_t>(moments.size(), 1));
   for (std::size_t m = 0; m < moments.size(); ++m)
      counts[m] = moments[m].count;
   return counts;
}

MassProperties Hierarchy::mass() const
{
   const auto &moments = m_root->moments(*m_placing);
   MassProperties sum;
   Vec3 first = Vec3::Zero();
   for (std::size_t m = 1; m < moments.size() && m <= m_model.materials->size(); ++m) {
      const double density = (*m_model.materials)[m - 1].density;
      sum.mass += density * moments[m].volume;
      first += density * moments[m].first;
   }
   if (sum.mass > 0)
      sum.centre = m_lattice->position({}) + first / sum.mass;
   return sum;
}

bool Hierarchy::findIn(const Summary &summary, Index i, std::vector<Placement> &path, Index &local) const
{
   if (!summary.bounds.contains(i))
      return false;
   if (!summary.body.cells.at(i).empty()) {
      local = i;
      return true;
   }
   const auto chunks = summary.body.instances.chunks();
   const auto tryChunk = [&](std::size_t c) {
      for (std::size_t n = 0; n < chunks[c]->size(); ++n) {
         const std::uint32_t kind = summary.kindOf[c][n];
         const Placement &p = (*chunks[c])[n];
         if (kind == Summary::kSkipped || !summary.kinds[kind].boxAt(p.origin).contains(i))
            continue;
         const Index inside = m_placing->unplace(p, i);
         if (!inRange(inside) || m_placing->place(p, inside) != i)
            continue;
         path.push_back(p);
         if (findIn(*summary.kinds[kind].summary, inside, path, local))
            return false;
         path.pop_back();
      }
      return true;
   };
   return !summary.chunkBoxes.visit([i](const Box &box) { return box.contains(i); }, tryChunk);
}

Found Hierarchy::found(const std::vector<Placement> &path, Index local) const
{
   const Summary *summary = m_root.get();
   if (!path.empty())
      summary = m_summaries.at(path.back().definition).get();
   Found found{local, summary->body.cells.at(local), path};
   for (auto p = path.rbegin(); p != path.rend(); ++p) {
      found.cell = m_placing->turned(*p, found.index, found.cell);
      found.index = m_placing->place(*p, found.index);
   }
   return found;
}

std::optional<Found> Hierarchy::find(Index i) const
{
   std::vector<Placement> path;
   Index local;
   if (!inRange(i) || !findIn(*m_root, i, path, local))
      return std::nullopt;
   return found(path, local);
}

Cell Hierarchy::at(Index i) const
{
   const auto found = find(i);
   return found ? found->cell : Cell();
}

std::vector<std::pair<Link, Found>> Hierarchy::neighbours(Index i) const
{
   std::vector<std::pair<Link, Found>> result;
   if (!inRange(i))
      return result;
   for (const Link &link : m_lattice->links(m_lattice->site(i)))
      if (auto there = find(i + link.offset))
         result.emplace_back(link, std::move(*there));
   return result;
}

bool Hierarchy::visitIn(const Summary &summary, const std::vector<Placement> &chain, const Box &box,
                        const std::function<bool(Index, Cell)> &visit) const
{
   const auto toWorld = [&](Index i, Cell cell) {
      for (auto p = chain.rbegin(); p != chain.rend(); ++p) {
         cell = m_placing->turned(*p, i, cell);
         i = m_placing->place(*p, i);
      }
      return !box.contains(i) || visit(i, cell);
   };
   Box part = box;
   for (const Placement &p : chain)
      part = m_placing->unplaceBox(p, part);
   if (!summary.body.cells.visit(part, toWorld))
      return false;
   const auto chunks = summary.body.instances.chunks();
   const auto enter = [&](const Box &b) { return b.intersects(part); };
   return summary.chunkBoxes.visit(enter, [&](std::size_t c) {
      for (std::size_t n = 0; n < chunks[c]->size(); ++n) {
         const std::uint32_t kind = summary.kindOf[c][n];
         const Placement &p = (*chunks[c])[n];
         if (kind == Summary::kSkipped || !enter(summary.kinds[kind].boxAt(p.origin)))
            continue;
         // A chain of allowed placements is one placement, so that depth costs nothing per cell.
         std::vector<Placement> inner = chain;
         Placement merged;
         if (!inner.empty() && m_placing->merge(inner.back(), p, merged))
            inner.back() = merged;
         else
            inner.push_back(p);
         if (!visitIn(*summary.kinds[kind].summary, inner, box, visit))
            return false;
      }
      return true;
   });
}

bool Hierarchy::visit(const Box &box, const std::function<bool(Index, Cell)> &visit) const
{
   return box.empty() || visitIn(*m_root, {}, box, visit);
}

std::vector<Index> Hierarchy::supercell(Index i) const
{
   const Cell cell = at(i);
   if (cell.empty())
      return {};
   std::vector<Index> run{i};
   if (!m_lattice->hasSupercells() || cell.joins == 0)
      return run;
   const auto step = [&](Index from) { return m_lattice->supercellStep(m_lattice->site(from)); };
   // Both cells of a joint must know of it: a run ends where its other half was erased.
   Index from = i;
   for (Cell here = cell; (here.joins & Cell::kJoinsNext) != 0;) {
      const Index to = from + step(from);
      here = at(to);
      if ((here.joins & Cell::kJoinsPrevious) == 0)
         break;
      run.push_back(to);
      from = to;
   }
   std::vector<Index> before;
   from = i;
   for (Cell here = cell; (here.joins & Cell::kJoinsPrevious) != 0;) {
      const Index to = from - step(from);
      here = at(to);
      if ((here.joins & Cell::kJoinsNext) == 0)
         break;
      before.push_back(to);
      from = to;
   }
   run.insert(run.begin(), before.rbegin(), before.rend());
   return run;
}

} // namespace diatom
