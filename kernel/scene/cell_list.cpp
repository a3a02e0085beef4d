// Neighbours are found without a search tree: for one offset the wanted indices grow with the cells, so a
// cursor per offset only ever moves forward.
#include "scene/cell_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace diatom {

namespace {

/// Finds growing targets in a sorted array, each in the logarithm of the distance to the one before.
class ForwardSearch
{
public:
   std::int64_t find(const std::vector<Index> &sorted, Index target)
   {
      const std::size_t left = sorted.size() - m_at;
      std::size_t reach = 1;
      while (reach < left && sorted[m_at + reach] < target)
         reach *= 2;
      const auto begin = sorted.begin() + static_cast<std::ptrdiff_t>(m_at);
      const auto found =
          std::lower_bound(begin + static_cast<std::ptrdiff_t>(reach / 2),
                           begin + static_cast<std::ptrdiff_t>(std::min(reach + 1, left)), target);
      m_at = static_cast<std::size_t>(found - sorted.begin());
      return found != sorted.end() && *found == target ? found - sorted.begin() : -1;
   }

private:
   std::size_t m_at = 0;
};

/// A step to a later cell, and whether it stays within the super-cell.
struct Step
{
   Index offset;
   bool alongRun = false;
   friend bool operator<(const Step &a, const Step &b) { return a.offset < b.offset; }
};

/// Steps from a site to later cells, in order; run steps win over joined links of the same offset.
std::vector<Step> stepsOf(const Lattice &lattice, int site)
{
   std::vector<Step> steps;
   if (lattice.hasSupercells()) {
      const Index along = lattice.supercellStep(site);
      steps.push_back({Index{} < along ? along : along * -1, true});
   }
   for (const Link &link : lattice.links(site))
      if (link.joined && Index{} < link.offset)
         steps.push_back({link.offset, false});
   std::stable_sort(steps.begin(), steps.end());
   return steps;
}

bool sameRun(const Lattice &lattice, const CellList &cells, std::int64_t a, std::int64_t b)
{
   const Index from = cells.index[static_cast<std::size_t>(a)];
   const bool forward = Index{} < lattice.supercellStep(lattice.site(from));
   const Cell first = cells.cell[static_cast<std::size_t>(forward ? a : b)];
   const Cell second = cells.cell[static_cast<std::size_t>(forward ? b : a)];
   return (first.joins & Cell::kJoinsNext) != 0 && (second.joins & Cell::kJoinsPrevious) != 0;
}

std::vector<JoinedPair> pairsFrom(const Lattice &lattice, const CellList &cells,
                                  const std::vector<std::vector<Step>> &steps, std::int64_t begin,
                                  std::int64_t end)
{
   std::vector<std::vector<ForwardSearch>> cursors;
   for (const auto &ofSite : steps)
      cursors.emplace_back(ofSite.size());
   std::vector<JoinedPair> pairs;
   for (std::int64_t a = begin; a < end; ++a) {
      const Index from = cells.index[static_cast<std::size_t>(a)];
      const auto site = static_cast<std::size_t>(lattice.site(from));
      for (std::size_t k = 0; k < steps[site].size(); ++k) {
         const Step &step = steps[site][k];
         const std::int64_t b = cursors[site][k].find(cells.index, from + step.offset);
         if (b < 0 || (step.alongRun && !sameRun(lattice, cells, a, b)))
            continue;
         if (!pairs.empty() && pairs.back().a == a && pairs.back().b == b)
            continue;
         pairs.push_back({static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), step.alongRun});
      }
   }
   return pairs;
}

} // namespace

std::int64_t CellList::find(Index i) const
{
   const auto found = std::lower_bound(index.begin(), index.end(), i);
   return found != index.end() && *found == i ? found - index.begin() : -1;
}

Result<CellList> listCells(const Hierarchy &hierarchy, const std::vector<bool> &wanted, std::int64_t limit,
                           const Job &job)
{
   struct Listed
   {
      Index index;
      Cell cell;
   };
   std::vector<Listed> listed;
   std::int64_t visited = 0;
   const bool complete = hierarchy.visit(hierarchy.bounds(), [&](Index i, Cell cell) {
      if (wanted.empty() || wanted[cell.material])
         listed.push_back({i, cell});
      return (++visited % 65536 != 0 || !job.cancelled()) &&
             static_cast<std::int64_t>(listed.size()) <= limit;
   });
   if (job.cancelled())
      return Error{ErrorCode::cancelled, "cancelled while listing the cells"};
   if (!complete)
      return Error{ErrorCode::invalid, fmt::format("the design has more than {} cells to look at one by one; "
                                                   "take a part of it, or a coarser lattice",
                                                   limit)};
   const auto before = [](const Listed &a, const Listed &b) { return a.index < b.index; };
   if (!std::is_sorted(listed.begin(), listed.end(), before))
      std::stable_sort(listed.begin(), listed.end(), before);

   CellList cells;
   cells.index.reserve(listed.size());
   cells.cell.reserve(listed.size());
   for (const Listed &one : listed) {
      if (!cells.index.empty() && cells.index.back() == one.index) {
         cells.cell.back() =
             hierarchy.at(one.index); // overlapping composites: the hierarchy says which one counts
         continue;
      }
      cells.index.push_back(one.index);
      cells.cell.push_back(one.cell);
   }
   return cells;
}

Result<std::vector<JoinedPair>> joinedPairs(const Lattice &lattice, const CellList &cells, const Job &job)
{
   std::vector<std::vector<Step>> steps(static_cast<std::size_t>(lattice.sites()));
   const auto period = lattice.period();
   for (std::int32_t x = 0; x < period[0]; ++x)
      for (std::int32_t y = 0; y < period[1]; ++y)
         for (std::int32_t z = 0; z < period[2]; ++z) {
            const int site = lattice.site({x, y, z});
            steps[static_cast<std::size_t>(site)] = stepsOf(lattice, site);
         }

   const std::int64_t pieces = (cells.count() + kCellGrain - 1) / kCellGrain;
   std::vector<std::vector<JoinedPair>> found(static_cast<std::size_t>(pieces));
   job.parallelFor(cells.count(), kCellGrain, [&](std::int64_t begin, std::int64_t end) {
      if (!job.cancelled())
         found[static_cast<std::size_t>(begin / kCellGrain)] = pairsFrom(lattice, cells, steps, begin, end);
   });
   if (job.cancelled())
      return Error{ErrorCode::cancelled, "cancelled while finding which cells are joined"};

   std::vector<JoinedPair> pairs;
   pairs.reserve(std::accumulate(found.begin(), found.end(), std::size_t{0},
                                 [](std::size_t sum, const auto &piece) { return sum + piece.size(); }));
   for (const auto &piece : found)
      pairs.insert(pairs.end(), piece.begin(), piece.end());
   return pairs;
}

std::vector<std::int32_t> connectedTo(std::int64_t count, const std::vector<JoinedPair> &pairs)
{
   std::vector<std::int32_t> parent(static_cast<std::size_t>(count));
   std::iota(parent.begin(), parent.end(), 0);
   const auto root = [&](std::int32_t i) {
      while (parent[static_cast<std::size_t>(i)] != i) {
         auto &up = parent[static_cast<std::size_t>(i)];
         up = parent[static_cast<std::size_t>(up)];
         i = up;
      }
      return i;
   };
   for (const JoinedPair &pair : pairs) {
      const std::int32_t a = root(pair.a), b = root(pair.b);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
   }
   for (std::int32_t i = 0; i < static_cast<std::int32_t>(count); ++i)
      parent[static_cast<std::size_t>(i)] = root(i);
   return parent;
}

} // namespace diatom
