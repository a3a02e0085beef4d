#include "parts/gathered_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace diatom {

namespace {

constexpr std::int64_t kGrain = 1 << 14;

struct Gathered
{
   Index index;
   Cell cell;
};

Error cancelledError() { return {ErrorCode::cancelled, "the decomposition into parts was cancelled"}; }

/// Every cell once, in index order. Where several overlap, the one the hierarchy shows.
Result<std::vector<Gathered>> sortedCells(const Hierarchy &hierarchy, const Job &job)
{
   constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
   if (hierarchy.cells() > kMost)
      return Error{
          ErrorCode::invalid,
          fmt::format("{} cells are too many to decompose into parts at once; at most {} are possible",
                      hierarchy.cells(), kMost)};
   std::vector<Gathered> cells;
   cells.reserve(static_cast<std::size_t>(hierarchy.cells()));
   const double total = static_cast<double>(std::max<std::uint64_t>(hierarchy.cells(), 1));
   const bool complete = hierarchy.visit(hierarchy.bounds(), [&](Index i, Cell cell) {
      cells.push_back({i, cell});
      if (cells.size() % 65536 == 0)
         job.progress(static_cast<double>(cells.size()) / total, "gathering cells");
      return cells.size() % 4096 != 0 || !job.cancelled();
   });
   if (!complete)
      return cancelledError();
   std::stable_sort(cells.begin(), cells.end(),
                    [](const Gathered &a, const Gathered &b) { return a.index < b.index; });
   std::size_t kept = 0;
   for (const Gathered &cell : cells) {
      if (kept > 0 && cells[kept - 1].index == cell.index) {
         cells[kept - 1].cell = hierarchy.at(cell.index);
         continue;
      }
      cells[kept++] = cell;
   }
   cells.resize(kept);
   return cells;
}

/// Place of the cell that follows cell `i` in its run, or -1. Two cells belong together when each says so.
std::int64_t nextInRun(const Lattice &lattice, const std::vector<Gathered> &cells, std::int64_t i)
{
   const Gathered &cell = cells[static_cast<std::size_t>(i)];
   if (!(cell.cell.joins & Cell::kJoinsNext))
      return -1;
   const Index wanted = cell.index + lattice.supercellStep(lattice.site(cell.index));
   const auto found = std::lower_bound(cells.begin(), cells.end(), wanted,
                                       [](const Gathered &a, const Index &index) { return a.index < index; });
   if (found == cells.end() || found->index != wanted || !(found->cell.joins & Cell::kJoinsPrevious))
      return -1;
   return found - cells.begin();
}

/// Numbers the runs: supercell = first cell of the run, place = position in it.
void findRuns(const Lattice &lattice, const std::vector<Gathered> &cells, GatheredCells &out, const Job &job)
{
   const auto count = static_cast<std::int64_t>(cells.size());
   for (std::int64_t i = 0; i < count; ++i)
      out.supercell[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(i);
   if (!lattice.hasSupercells())
      return;
   std::vector<std::int32_t> next(cells.size(), -1);
   job.parallelFor(count, kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i)
         next[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(nextInRun(lattice, cells, i));
   });
   std::vector<bool> first(cells.size(), true);
   for (const std::int32_t cell : next)
      if (cell >= 0)
         first[static_cast<std::size_t>(cell)] = false;
   for (std::size_t start = 0; start < cells.size(); ++start) {
      if (!first[start])
         continue;
      std::int32_t place = 0;
      for (auto cell = static_cast<std::int32_t>(start); cell >= 0;
           cell = next[static_cast<std::size_t>(cell)]) {
         out.supercell[static_cast<std::size_t>(cell)] = static_cast<std::int32_t>(start);
         out.place[static_cast<std::size_t>(cell)] = place++;
      }
   }
}

} // namespace

diatom_cells GatheredCells::record(const LatticeSpec &lattice) const
{
   static_assert(sizeof(Index) == 3 * sizeof(std::int32_t));
   return {sizeof(diatom_cells), static_cast<std::int64_t>(index.size()),
           lattice.pitch,        index.empty() ? nullptr : &index.front().x,
           site.data(),          material.data(),
           supercell.data(),     place.data(),
           position.data(),      orientation.data(),
           lattice.id.c_str()};
}

Result<GatheredCells> gatherCells(const Hierarchy &hierarchy, const Job &job)
{
   auto sorted = sortedCells(hierarchy, job);
   if (!sorted)
      return sorted.error();
   const std::vector<Gathered> cells = *std::move(sorted);
   const Lattice &lattice = hierarchy.lattice();
   for (const Gathered &cell : cells)
      if (cell.cell.orientation >= lattice.shape(lattice.site(cell.index)).rotations.size())
         return Error{ErrorCode::invalid,
                      fmt::format("the cell at {} {} {} has orientation {}, which its shape does not have",
                                  cell.index.x, cell.index.y, cell.index.z, cell.cell.orientation)};

   GatheredCells out;
   const std::size_t count = cells.size();
   out.index.resize(count);
   out.site.resize(count);
   out.material.resize(count);
   out.supercell.resize(count);
   out.place.resize(count, 0);
   out.position.resize(3 * count);
   out.orientation.resize(4 * count);
   job.parallelFor(static_cast<std::int64_t>(count), kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
         const auto &[index, cell] = cells[i];
         const int site = lattice.site(index);
         const Vec3 at = lattice.position(index);
         const Quat turn =
             (lattice.orientation(site) * lattice.shape(site).rotations[cell.orientation]).normalized();
         out.index[i] = index;
         out.site[i] = site;
         out.material[i] = cell.material;
         std::copy_n(at.data(), 3, out.position.data() + 3 * i);
         const double wxyz[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
         std::copy_n(wxyz, 4, out.orientation.data() + 4 * i);
      }
   });
   findRuns(lattice, cells, out, job);
   if (job.cancelled())
      return cancelledError();
   return out;
}

} // namespace diatom
