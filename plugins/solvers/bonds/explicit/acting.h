// Forces on every cell at a moment. Read when asked for, not while stepping.
#pragma once

#include "model/coupling.h"

namespace bonds {

/// Force and moment, six numbers a cell, world axes.
struct Acting
{
   Column internal; // of bonds and whatever else acts between cells
   Column all;      // with gravity, loads, drag and ground
};

/// `loads` are six numbers a cell, empty without any; `rest` the actuated rest shape, null without.
Acting actingOn(const Assembly &assembly, const Couplings &couplings, const State &state,
                const RestShape *rest, const Column &loads);

/// What supports and drives supply: the force out of balance where a degree of freedom is held, 0 elsewhere.
Column reactions(const Assembly &assembly, const State &state, const Acting &acting);

/// Velocities after `dt` under the forces of the moment.
void kickBy(const Assembly &assembly, const Acting &acting, double dt, State &state);

} // namespace bonds
