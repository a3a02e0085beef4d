// Forces of all bonds, each bond once, and their sums per cell; the same bits for any number of threads.
#pragma once

#include "model/actuation.h"

namespace bonds {

/// Flushes denormals while it lives and restores the caller's mode: motion that dies away would otherwise
/// cost ten times as much. Made in every chunk, because worker threads have modes of their own.
class FlushDenormals
{
public:
   FlushDenormals();
   ~FlushDenormals();
   FlushDenormals(const FlushDenormals &) = delete;
   FlushDenormals &operator=(const FlushDenormals &) = delete;

private:
   unsigned m_saved = 0;
};

inline constexpr std::int64_t kGrain = 1024; // bonds or cells per piece; sums are made per piece
inline constexpr std::int64_t kCellsForThreads =
    2000; // smaller scenes lose more to waking threads than they gain

/// Runs body(begin, end, piece) over pieces of kGrain: in place for small scenes, else by the host's threads.
template<typename Body>
void inPieces(const sdk::Call &call, bool threads, std::int64_t count, const Body &body)
{
   auto run = [&](std::int64_t begin, std::int64_t end) {
      const FlushDenormals mode;
      for (std::int64_t i = begin; i < end; i += kGrain)
         body(i, std::min(i + kGrain, end), i / kGrain);
   };
   if (threads)
      call.parallelFor(count, kGrain, run);
   else
      run(0, count);
}

/// Force on a, torques on a and b of every bond, world axes.
class BondForcesPass
{
public:
   BondForcesPass(const Assembly &assembly, bool actuated);
   /// Returns the power dissipated (W).
   double run(const sdk::Call &call, const State &state, const RestShape &rest);
   /// Sum of the bonds of cell i, in bond order.
   void gather(std::int64_t i, Vec3 &force, Vec3 &torque) const;

private:
   template<bool Damped, bool Actuated, bool Coupled, Law kLaw>
   void range(const State &state, const RestShape &rest, std::int64_t begin, std::int64_t end, double &power);
   using Range = void (BondForcesPass::*)(const State &, const RestShape &, std::int64_t, std::int64_t,
                                          double &);
   template<Law kLaw>
   static Range select(bool damped, bool actuated, bool coupled);

   const Assembly *m_assembly;
   Range m_range;
   std::array<Column, 9> m_out;
   Column m_power;
};

} // namespace bonds
