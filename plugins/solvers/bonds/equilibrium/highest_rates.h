// What truly limits explicit steps: the fastest vibration of a whole scene and its strongest damping, where
// model/stable_step.h bounds both by single bonds.
#pragma once

#include "equilibrium/balance.h"

#include <optional>

namespace bonds {

/// Largest eigenvalues over the masses of stiffness (rad2/s2) and of damping without drag (1/s).
struct HighestRates
{
   double stiffness = 0, damping = 0;
};

/// Of the scene at rest and unloaded, with the ground under every cell where there is one. Found from below;
/// what they may lack is added. Takes some 3 kB a cell while it works. Nothing when cancelled.
std::optional<HighestRates> highestRates(const sdk::Call &call, const Balance &balance);

} // namespace bonds
