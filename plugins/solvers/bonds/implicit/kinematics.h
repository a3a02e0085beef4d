// What an implicit step goes on from.
#pragma once

#include "equilibrium/block_matrix.h"
#include "model/state.h"

namespace bonds {

/// Vectors hold 6 numbers a cell: along the world axes, then about them.
struct Kinematics
{
   explicit Kinematics(std::int64_t cells)
       : state(cells), rate(Vector::Zero(6 * cells)), carried(rate), trend(rate)
   {}

   double time = 0; // s
   State state;
   Vector rate;     // of velocity and spin, now
   Vector carried;  // the method's auxiliary acceleration
   Vector trend;    // mean acceleration over the last step
   Column driven;   // value of each driven degree of freedom
   double step = 0; // s, that `carried` belongs to; 0 at the start
};

} // namespace bonds
