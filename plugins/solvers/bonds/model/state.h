// What moves: displacement, turn, velocity and spin of every cell as thirteen columns, and where friction
// holds on.
#pragma once

#include "model/assembly.h"

namespace bonds {

/// Displacements from rest keep their digits however far from the origin a part lies.
struct State
{
   explicit State(std::int64_t cells, Law law = Law::exact)
       : n(cells), smallTurns(law == Law::small), block(static_cast<std::size_t>(13 * cells))
   {
      std::fill_n(column(3), n, 1.0);
   }

   double *column(int k) { return block.data() + k * n; }
   const double *column(int k) const { return block.data() + k * n; }
   double *displacement(int k) { return column(k); }
   double *velocity(int k) { return column(7 + k); }
   double *spin(int k) { return column(10 + k); }

   Vec3 displacementOf(std::int64_t i) const { return {column(0)[i], column(1)[i], column(2)[i]}; }
   Quat turnOf(std::int64_t i) const { return {column(3)[i], column(4)[i], column(5)[i], column(6)[i]}; }
   Vec3 velocityOf(std::int64_t i) const { return {column(7)[i], column(8)[i], column(9)[i]}; }
   Vec3 spinOf(std::int64_t i) const { return {column(10)[i], column(11)[i], column(12)[i]}; }
   void setTurn(std::int64_t i, Quat q)
   {
      column(3)[i] = q.w;
      column(4)[i] = q.x;
      column(5)[i] = q.y;
      column(6)[i] = q.z;
   }
   /// Rotation vector.
   Vec3 turnVectorOf(std::int64_t i) const { return smallTurns ? 2 * vec(turnOf(i)) : logarithm(turnOf(i)); }
   /// As a unit quaternion.
   Quat unitTurnOf(std::int64_t i) const { return smallTurns ? exponential(turnVectorOf(i)) : turnOf(i); }
   /// Sets the turn to what `q` becomes by the rotation vector `v`.
   void setTurnedOn(std::int64_t i, Quat q, Vec3 v)
   {
      if (smallTurns)
         return setTurn(i, {1, q.x + 0.5 * v.x, q.y + 0.5 * v.y, q.z + 0.5 * v.z});
      const Quat now = exponential(v) * q;
      const double f = 1 / std::sqrt(now.w * now.w + dot(vec(now), vec(now)));
      setTurn(i, {f * now.w, f * now.x, f * now.y, f * now.z});
   }
   void setSpin(std::int64_t i, Vec3 w)
   {
      spin(0)[i] = w.x;
      spin(1)[i] = w.y;
      spin(2)[i] = w.z;
   }

   std::int64_t n;
   bool smallTurns;            // rotation vectors add up: turns are 1 and half of them
   Column block;               // u, turn since rest (w x y z), v, w
   std::array<Column, 2> grip; // m, tangential spring of the ground contact; empty without friction
};

/// A bond's ends in its own axes, as they stand: without velocities and spins.
inline Ends poseOf(const Assembly &assembly, const State &state, std::int64_t bond, const Mat3 &frame)
{
   const std::int64_t a = assembly.a[bond], b = assembly.b[bond];
   Ends ends;
   ends.length = assembly.lengthOf(bond);
   ends.separation = frame * (state.displacementOf(b) - state.displacementOf(a));
   ends.separation.x += ends.length;
   ends.qa = inAxes(frame, state.turnOf(a));
   ends.qb = inAxes(frame, state.turnOf(b));
   return ends;
}

/// A bond's ends in its own axes.
inline Ends endsOf(const Assembly &assembly, const State &state, std::int64_t bond)
{
   const Mat3 frame = assembly.frameOf(bond);
   const std::int64_t a = assembly.a[bond], b = assembly.b[bond];
   Ends ends = poseOf(assembly, state, bond, frame);
   ends.dv = frame * (state.velocityOf(b) - state.velocityOf(a));
   ends.wa = frame * state.spinOf(a);
   ends.wb = frame * state.spinOf(b);
   return ends;
}

inline Relation relationOf(const Assembly &assembly, const State &state, std::int64_t bond)
{
   const Ends ends = poseOf(assembly, state, bond, assembly.frameOf(bond));
   return state.smallTurns ? relateSmall(ends) : relate(ends);
}

/// Own axes of a box cell as it is turned now; turns that only count to first order leave its inertia.
inline Mat3 ownAxes(const Assembly &assembly, std::int64_t i, Quat turn)
{
   return matrix(assembly.law == Law::small ? assembly.orientation[i] : turn * assembly.orientation[i]);
}

/// Inertia tensor of a box cell as it is turned now, and its inverse, applied to a world vector.
inline Vec3 spinMomentum(const Assembly &assembly, std::int64_t i, Quat turn, Vec3 w)
{
   if (!assembly.boxes)
      return assembly.inertia[i] * w;
   const Mat3 own = ownAxes(assembly, i, turn);
   const Vec3 v = transposed(own, w);
   return own * Vec3{assembly.boxInertia[0][i] * v.x, assembly.boxInertia[1][i] * v.y,
                     assembly.boxInertia[2][i] * v.z};
}

/// Spin of a box cell from its angular momentum; where it is held, the spin stays `held`.
inline Vec3 spinFrom(const Assembly &assembly, std::int64_t i, Quat turn, Vec3 momentum, Vec3 held)
{
   const Mat3 own = ownAxes(assembly, i, turn);
   const Vec3 v = transposed(own, momentum);
   Vec3 w = own * Vec3{v.x / assembly.boxInertia[0][i], v.y / assembly.boxInertia[1][i],
                       v.z / assembly.boxInertia[2][i]};
   const int mask = assembly.fixed[i] >> 3;
   if (mask & 1)
      w.x = held.x;
   if (mask & 2)
      w.y = held.y;
   if (mask & 4)
      w.z = held.z;
   return w;
}

/// Changes the velocities of a cell by what a force and a torque do in `dt`.
inline void kickCell(const Assembly &assembly, std::int64_t i, double dt, Vec3 force, Vec3 torque,
                     State &state)
{
   state.velocity(0)[i] += dt * assembly.inverseMass(i, 0) * force.x;
   state.velocity(1)[i] += dt * assembly.inverseMass(i, 1) * force.y;
   state.velocity(2)[i] += dt * assembly.inverseMass(i, 2) * force.z;
   if (assembly.boxes) {
      const Quat q = state.turnOf(i);
      const Vec3 w = state.spinOf(i);
      state.setSpin(i, spinFrom(assembly, i, q, spinMomentum(assembly, i, q, w) + dt * torque, w));
      return;
   }
   state.spin(0)[i] += dt * assembly.inverseInertia(i, 0) * torque.x;
   state.spin(1)[i] += dt * assembly.inverseInertia(i, 1) * torque.y;
   state.spin(2)[i] += dt * assembly.inverseInertia(i, 2) * torque.z;
}

} // namespace bonds
