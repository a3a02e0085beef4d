// Balances of a moment: energies, momenta, strain. Read when asked for, not while stepping.
#pragma once

#include "model/coupling.h"

namespace bonds {

struct Energies
{
   double kinetic = 0, elastic = 0, gravity = 0, contact = 0; // J, stored
   double stored() const { return kinetic + elastic + gravity + contact; }
};

/// `rest` is the actuated rest shape, null when nothing is driven; likewise below.
Energies energies(const Assembly &assembly, const Couplings &couplings, const State &state,
                  const RestShape *rest);

double kineticEnergy(const Assembly &assembly, const State &state);

struct Momenta
{
   Vec3 linear, angular; // angular about the origin
};
Momenta momenta(const Assembly &assembly, const State &state);

/// Largest axial strain, in magnitude, of each cell's bonds, against the rest length of the moment.
Column strains(const Assembly &assembly, const State &state, const RestShape *rest);

/// The bond that holds most energy or none that is a number; -1 without bonds.
std::int64_t worstBond(const Assembly &assembly, const State &state, const RestShape *rest);
/// The first cell whose state is no number; -1 when all are.
std::int64_t brokenCell(const Assembly &assembly, const State &state);

} // namespace bonds
