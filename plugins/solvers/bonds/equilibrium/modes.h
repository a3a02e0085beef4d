// The lowest and the highest vibrations about a balance. The lowest: K x = w^2 M x by shift-invert Lanczos
// with several starting vectors, so that repeated frequencies are found as often as they are there (Grimes,
// Lewis and Simon, SIAM J. Matrix Anal. Appl. 15, 1994), and with full orthogonalisation. The highest: the
// same without inverting.
#pragma once

#include "equilibrium/newton.h"

namespace bonds {

struct ModeShapes
{
   Column eigenvalue;         // rad2/s2, ascending
   std::vector<Vector> shape; // displacement and turn of every cell, of unit modal mass
   bool cancelled = false;
   bool complete = true; // all that were wanted are as sharp as wanted
};

/// At most `wanted` of them.
ModeShapes lowestModes(const sdk::Call &call, const Balance &balance, const State &state,
                       const Loading &loading, std::int64_t wanted);
ModeShapes highestModes(const sdk::Call &call, const Balance &balance, const State &state,
                        const Loading &loading, std::int64_t wanted);

} // namespace bonds
