// The ends of a bond of a scene, in the bond's own axes.
#pragma once

#include "model/bond_tangent.h"
#include "model/state.h"

namespace bonds {

template<bool Rates>
BondEnds bondEnds(const Assembly &assembly, const State &state, std::int64_t bond, const Mat3 &frame)
{
   const std::int64_t a = assembly.a[bond], b = assembly.b[bond];
   BondEnds ends;
   ends.displacement = frame * (state.displacementOf(b) - state.displacementOf(a));
   ends.length = assembly.lengthOf(bond);
   ends.small = state.smallTurns;
   ends.qa = inAxes(frame, state.turnOf(a));
   ends.qb = inAxes(frame, state.turnOf(b));
   if constexpr (Rates) {
      ends.dv = frame * (state.velocityOf(b) - state.velocityOf(a));
      ends.wa = frame * state.spinOf(a);
      ends.wb = frame * state.spinOf(b);
   }
   return ends;
}

} // namespace bonds
