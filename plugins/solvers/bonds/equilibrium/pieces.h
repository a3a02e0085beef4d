// Work on all cells or bonds at once, cut so that the cuts do not depend on the number of threads.
#pragma once

#include <diatom/solver.hpp>

#include <algorithm>
#include <cstdint>

namespace bonds {

namespace sdk = diatom::sdk;

inline constexpr std::int64_t kPiece = 256;
/// Waking threads costs more than smaller scenes take.
inline constexpr std::int64_t kWorthThreads = 1000;

inline std::int64_t piecesOf(std::int64_t count) { return (count + kPiece - 1) / kPiece; }

/// body(begin, end, piece) for all of them.
template<typename Body>
void forPieces(const sdk::Call &call, std::int64_t count, const Body &body)
{
   auto run = [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; i += kPiece)
         body(i, std::min(i + kPiece, end), i / kPiece);
   };
   if (count < kWorthThreads)
      run(0, count);
   else
      call.parallelFor(count, kPiece, run);
}

} // namespace bonds
