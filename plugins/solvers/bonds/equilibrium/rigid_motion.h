// How parts of a scene can still move as a whole: the rigid motions that no held degree of freedom resists.
#pragma once

#include "equilibrium/balance.h"

namespace bonds {

/// A part of joined cells that nothing keeps in place.
struct LooseMotion
{
   std::int64_t cell = -1; // of the part; -1: every part is held
   int freedom = 0;        // the axis that its motion follows most: 0 to 2 moves along, 3 to 5 turns about
};

/// The first part, in order of cells, that can drift as a whole at `state`.
LooseMotion findLoose(const Balance &balance, const State &state);
/// Throws one sentence where some part is free to drift.
void refuseLoose(const Balance &balance, const State &state);
/// "move along x", "turn about z"
std::string freedomText(int freedom);

} // namespace bonds
