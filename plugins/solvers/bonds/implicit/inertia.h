// Mass and inertia of cells; that of a box turns with it.
#pragma once

#include "model/state.h"

#include <Eigen/Dense>

namespace bonds {

/// Inertia tensor of a cell as it is turned, world axes.
Eigen::Matrix3d inertiaOf(const Assembly &assembly, std::int64_t cell, Quat turn);

/// What it takes to change velocity and spin at `rate` (6 numbers), spin included: m v', I w' + w x I w.
void inertiaForce(const Assembly &assembly, const State &state, std::int64_t cell, const double *rate,
                  double *out);

/// The rate of velocity and spin that `force` (6 numbers) brings about where `free` (6 numbers) is not 0,
/// spin included. What is held does not change.
void accelerate(const Assembly &assembly, const State &state, std::int64_t cell, const double *free,
                const double *force, double *rate);

} // namespace bonds
