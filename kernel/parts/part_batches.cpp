#include "parts/part_batches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace diatom {

PartBatches::PartBatches(const GatheredCells &cells, std::vector<PartType> types)
    : m_cells(cells), m_types(std::move(types))
{}

diatom_part_sink PartBatches::sink() { return {sizeof(diatom_part_sink), this, take}; }

std::int32_t PartBatches::take(const diatom_part_sink *sink, const diatom_part_batch *batch)
{
   auto &self = *static_cast<PartBatches *>(sink->host);
   try {
      if (!batch || !DIATOM_HAS(diatom_part_batch, batch, covered) || batch->count < 0)
         self.m_fault = "a batch of parts is broken";
      else
         self.add(*batch);
   } catch (const std::bad_alloc &) {
      return DIATOM_NO_MEMORY;
   }
   return self.m_fault.empty() ? DIATOM_OK : DIATOM_BAD_INPUT;
}

std::string PartBatches::cellName(std::int64_t cell) const
{
   const Index index = m_cells.index[static_cast<std::size_t>(cell)];
   return fmt::format("{} {} {}", index.x, index.y, index.z);
}

std::string PartBatches::faultOf(const diatom_part_batch &batch, std::int64_t part) const
{
   const auto cells = static_cast<std::int64_t>(m_cells.index.size());
   const std::int64_t first = batch.covered_start[part], last = batch.covered_start[part + 1];
   if (last <= first || last - first > cells)
      return "covers no cell";
   for (std::int64_t i = first; i < last; ++i)
      if (batch.covered[i] < 0 || batch.covered[i] >= cells)
         return "covers a cell that does not exist";
   if (batch.type[part] < 0 || static_cast<std::size_t>(batch.type[part]) >= m_types.size())
      return fmt::format("is of type {}, which is not in the catalogue", batch.type[part]);
   if (batch.length[part] < 1)
      return fmt::format("is {} cells long", batch.length[part]);
   const double *position = batch.position + 3 * part, *turn = batch.orientation + 4 * part;
   if (!std::all_of(position, position + 3, [](double v) { return std::isfinite(v); }))
      return "is at a place that is not finite";
   const double norm = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3];
   if (!(std::abs(norm - 1) < 1e-6))
      return "has an orientation that is not a unit quaternion";
   for (std::int64_t i = first; i < last; ++i)
      if (batch.material[part] != m_cells.material[static_cast<std::size_t>(batch.covered[i])])
         return fmt::format("has material {}, unlike the cell at {} that it covers", batch.material[part],
                            cellName(batch.covered[i]));
   return {};
}

void PartBatches::add(const diatom_part_batch &batch)
{
   for (std::int64_t i = 0; i < batch.count; ++i) {
      if (const std::string fault = faultOf(batch, i); !fault.empty()) {
         const std::int64_t first = batch.covered_start[i];
         const bool known = batch.covered_start[i + 1] > first && batch.covered[first] >= 0 &&
                            batch.covered[first] < static_cast<std::int64_t>(m_cells.index.size());
         m_fault = known
                       ? fmt::format("the part for the cell at {} {}", cellName(batch.covered[first]), fault)
                       : fmt::format("part {} {}", m_parts.size(), fault);
         return;
      }
      const std::int64_t *first = batch.covered + batch.covered_start[i];
      const std::int64_t *last = batch.covered + batch.covered_start[i + 1];
      const double *position = batch.position + 3 * i, *turn = batch.orientation + 4 * i;
      Part part;
      part.type = batch.type[i];
      part.length = batch.length[i];
      part.material = static_cast<MaterialIndex>(batch.material[i]);
      part.position = {position[0], position[1], position[2]};
      part.orientation = Quat(turn[0], turn[1], turn[2], turn[3]).normalized();
      part.firstCell = static_cast<std::int64_t>(m_covered.size());
      part.cells = last - first;
      m_covered.insert(m_covered.end(), first, last);
      std::sort(m_covered.end() - part.cells, m_covered.end());
      m_parts.push_back(part);
   }
}

Status PartBatches::checkCoverage(bool partial, std::vector<Index> &left) const
{
   std::int64_t whole = 1; // a number that every share divides: sums of 1/share become exact
   for (const PartType &type : m_types) {
      whole = std::lcm(whole, static_cast<std::int64_t>(type.share));
      if (whole > 1'000'000'000)
         return Error{ErrorCode::internal, "the shares of its part types have no common multiple below 10^9"};
   }
   std::vector<std::int64_t> sum(m_cells.index.size(), 0);
   for (const Part &part : m_parts)
      for (std::int64_t i = 0; i < part.cells; ++i)
         sum[static_cast<std::size_t>(m_covered[static_cast<std::size_t>(part.firstCell + i)])] +=
             whole / m_types[static_cast<std::size_t>(part.type)].share;
   for (std::size_t i = 0; i < sum.size(); ++i) {
      if (sum[i] == 0 && partial)
         left.push_back(m_cells.index[i]);
      else if (sum[i] != whole)
         return Error{ErrorCode::internal,
                      fmt::format("the cell at {} is {}", cellName(static_cast<std::int64_t>(i)),
                                  sum[i] == 0      ? "covered by no part"
                                  : sum[i] > whole ? "covered more than once"
                                                   : "covered in part only")};
   }
   return {};
}

Result<Decomposition> PartBatches::finish(bool partial) const
{
   Decomposition out;
   if (const Status status = checkCoverage(partial, out.left); !status)
      return status.error();
   // Cells are in index order, so places order like indices. Parts that share a cell are told apart by their
   // content.
   const auto key = [&](const Part &part) {
      const Vec3 &p = part.position;
      const Quat &q = part.orientation;
      return std::make_tuple(m_covered[static_cast<std::size_t>(part.firstCell)], part.type, part.length,
                             p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
   };
   out.types = m_types;
   out.parts = m_parts;
   std::stable_sort(out.parts.begin(), out.parts.end(),
                    [&](const Part &a, const Part &b) { return key(a) < key(b); });
   out.covered.reserve(m_covered.size());
   for (Part &part : out.parts) {
      const auto first = static_cast<std::size_t>(part.firstCell);
      part.firstCell = static_cast<std::int64_t>(out.covered.size());
      for (std::size_t i = 0; i < static_cast<std::size_t>(part.cells); ++i)
         out.covered.push_back(m_cells.index[static_cast<std::size_t>(m_covered[first + i])]);
   }
   return out;
}

} // namespace diatom
