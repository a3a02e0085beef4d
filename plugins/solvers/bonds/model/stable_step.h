// The largest step that an explicit integrator may take: a guaranteed bound from the eigenvalues of single
// bonds and the row sums of couplings.
#pragma once

#include "model/coupling.h"

namespace bonds {

struct StableStep
{
   double step = 0;        // s
   std::int64_t bond = -1; // that sets it
   std::int64_t cell = -1; // whose ground contact or coupling sets it
};

/// The result when nothing in the scene limits the step (no stiffness, no damping): a step for accuracy
/// alone.
inline constexpr double kFreeStep = 1e-3;

StableStep stableStep(const Assembly &assembly, const Options &options, const Couplings &couplings);

/// The longest step (s) that an integrator may take where nothing swings faster than `w2` (rad2/s2) or is
/// damped more strongly than `g` (1/s), drag left out.
double longestStep(const Assembly &assembly, const Options &options, const Couplings &couplings, double w2,
                   double g);

} // namespace bonds
