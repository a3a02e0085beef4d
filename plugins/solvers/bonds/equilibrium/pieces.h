// Work on all cells at once, cut so that the cuts do not depend on the number of threads.
#pragma once

#include <diatom/solver.hpp>

#include <algorithm>
#include <cstdint>

namespace bonds {

namespace sdk = diatom::sdk;

inline constexpr std::int64_t kCellsPerPiece = 256;
/// Waking threads costs more than smaller scenes take.
inline constexpr std::int64_t kCellsForTwo = 1000;

inline std::int64_t piecesOf(std::int64_t cells) { return (cells + kCellsPerPiece - 1) / kCellsPerPiece; }

/// body(begin, end, piece) for all cells.
template<typename Body>
void forCells(const sdk::Call &call, std::int64_t cells, const Body &body)
{
   auto run = [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; i += kCellsPerPiece)
         body(i, std::min(i + kCellsPerPiece, end), i / kCellsPerPiece);
   };
   if (cells < kCellsForTwo)
      run(0, cells);
   else
      call.parallelFor(cells, kCellsPerPiece, run);
}

} // namespace bonds
