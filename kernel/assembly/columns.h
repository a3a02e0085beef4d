// Which cells lie over one another when seen from above: cells of equal outline at one place make a column,
// and columns whose outlines overlap get in each other's way.
#pragma once

#include "core/index.h"
#include "lattice/lattice.h"

#include <cstdint>
#include <span>
#include <vector>

namespace diatom {

/// Immutable once made. Touching outlines do not overlap.
class Columns
{
public:
   Columns(const Lattice &lattice, std::span<const Index> cells);

   int count() const { return static_cast<int>(m_start.size()) - 1; }
   /// Column of the n-th cell.
   int of(std::size_t cell) const { return m_columnOf[cell]; }
   /// Columns whose outline overlaps this one's, itself included, ascending.
   std::span<const std::int32_t> overlapping(int column) const
   {
      const auto c = static_cast<std::size_t>(column);
      return {m_overlaps.data() + m_start[c], m_overlaps.data() + m_start[c + 1]};
   }

private:
   std::vector<std::int32_t> m_columnOf;
   std::vector<std::int64_t> m_start; // columns + 1, into m_overlaps
   std::vector<std::int32_t> m_overlaps;
};

} // namespace diatom
