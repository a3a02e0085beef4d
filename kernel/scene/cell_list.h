// The cells of a hierarchy as sorted flat arrays, and the pairs of them that the lattice holds together.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"

#include <cstdint>
#include <vector>

namespace diatom {

inline constexpr std::int64_t kCellGrain = 1 << 14; // cells in a piece of parallel work

/// Sorted by (x, y, z), each index once.
struct CellList
{
   std::vector<Index> index;
   std::vector<Cell> cell;

   std::int64_t count() const { return static_cast<std::int64_t>(index.size()); }
   /// Number of the cell at an index, -1 when there is none.
   std::int64_t find(Index i) const;
};

/// Cells whose material is marked in `wanted` (by material index; empty = all). Errors: more than `limit`,
/// cancelled.
Result<CellList> listCells(const Hierarchy &hierarchy, const std::vector<bool> &wanted, std::int64_t limit,
                           const Job &job);

/// Two cells held together, a < b: by the lattice's own connection, or as neighbours within one super-cell.
struct JoinedPair
{
   std::int32_t a = 0, b = 0;
   bool withinSupercell = false;
};

/// Sorted by (a, b), each pair once. Errors: cancelled.
Result<std::vector<JoinedPair>> joinedPairs(const Lattice &lattice, const CellList &cells, const Job &job);

/// For each of `count` things the smallest one it hangs together with through the pairs.
std::vector<std::int32_t> connectedTo(std::int64_t count, const std::vector<JoinedPair> &pairs);

} // namespace diatom
