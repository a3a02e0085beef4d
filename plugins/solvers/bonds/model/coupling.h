// Whatever acts between cells beside bonds: solid elements, Poisson coupling. Explicit and equilibrium
// analyses ask it for forces, energy and stiffness; a scene that calls for none has none in its list.
#pragma once

#include "model/actuation.h"

#include <functional>
#include <memory>
#include <vector>

namespace bonds {

/// Force (columns 0-2) and moment (3-5) on every cell, world axes.
using CellForces = std::array<Column, 6>;

/// Receives a 6 x 6 block, row-major: change of (force, moment) that the coupling exerts on `row`, negated,
/// per displacement and spin (world axes) of `column`.
using AddBlock = std::function<void(std::int64_t row, std::int64_t column, const double *block)>;

/// Immutable but for room to work in: one call at a time. Sums run in a fixed order, so that results have the
/// same bits on any number of threads.
class Coupling
{
public:
   virtual ~Coupling() = default;
   /// Adds the forces at `state`; returns the power (W) that its damping takes out. `rest` is the actuated
   /// rest shape, null when nothing is driven; likewise below.
   virtual double addForces(const sdk::Call &call, const State &state, const RestShape *rest,
                            CellForces &forces) const = 0;
   virtual double energy(const State &state, const RestShape *rest) const = 0; // J
   /// Tangent stiffness at `state`, symmetric up to the moments in it.
   virtual void addStiffness(const State &state, const RestShape *rest, const AddBlock &add) const = 0;
   /// Change of the forces, negated, per velocity and spin: the other half of an implicit step's tangent.
   virtual void addDamping(const State &state, const AddBlock &add) const = 0;
   /// Adds to each degree of freedom of each cell at least the largest sum of magnitudes in its row of the
   /// stiffness (N/m; N m/rad) and of the damping at rest: what a bound of the stable step needs.
   virtual void addRowSums(CellForces &stiffness, CellForces &damping) const = 0;
};

using Couplings = std::vector<std::unique_ptr<const Coupling>>;

} // namespace bonds
