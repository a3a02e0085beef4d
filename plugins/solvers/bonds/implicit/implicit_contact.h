// Contact with the ground at the end of an implicit step: the law of model/contact.h, its friction found by
// trying to stick first (the return map of plasticity; Simo and Laursen, Computers & Structures 42, 1992).
#pragma once

#include "equilibrium/block_matrix.h"
#include "model/contact.h"

namespace bonds {

/// Force of the ground on one cell, beside the spring that a balance counts itself.
struct ContactForce
{
   double normal = 0; // N, spring and damper, never pulling
   double along[2]{}; // N, friction
   double grip[2]{};  // m, the friction spring at the end of the step
   double tried[2]{}; // N, what sticking would take
   bool slips = false;
};

/// `from` is where the step began, `increment` what the cell moves and turns by in it.
ContactForce contactForce(const Assembly &assembly, const State &from, const State &to, std::int64_t cell,
                          const double *increment);

/// Negative derivative of that force by displacement and spin; `speedBy` is that of velocities. Not symmetric
/// where the cell slips.
void addContactTangent(const Assembly &assembly, const ContactForce &force, std::int64_t cell, double speedBy,
                       Eigen::Map<Block> to);

} // namespace bonds
