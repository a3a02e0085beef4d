// Ground contact of a cell: a spring and damper at its lower face that never pulls, and friction that sticks.
#pragma once

#include "model/state.h"

namespace bonds {

/// Running sums of a piece of cells (J).
struct Sums
{
   double dissipated = 0, work = 0;
};

inline double penetration(const Assembly &assembly, const State &state, std::int64_t i)
{
   return assembly.ground.height - (assembly.rest[2][i] + state.column(2)[i] - assembly.halfHeight[i]);
}

/// Velocity along the ground of the contact point, which stays halfHeight below the centre.
inline std::array<double, 2> slipVelocity(const Assembly &assembly, const State &state, std::int64_t i)
{
   const double h = assembly.halfHeight[i];
   return {state.column(7)[i] - h * state.column(11)[i], state.column(8)[i] + h * state.column(10)[i]};
}

/// Adds the contact's force and torque. `ahead` is the time since the friction springs were last moved (inner
/// stages of a step); only with 0 may they slip. `dt` weights what is dissipated. Friction is Cundall
/// and Strack's: a tangential spring and damper whose force is cut at mu N, the spring being dragged along
/// (Geotechnique 29, 1979).
inline void addContact(const Assembly &assembly, State &state, std::int64_t i, double ahead, double dt,
                       Vec3 &force, Vec3 &torque, Sums &sums)
{
   const Ground &ground = assembly.ground;
   const double depth = penetration(assembly, state, i), k = ground.stiffness;
   const bool friction = assembly.hasFriction;
   if (!(depth > 0)) {
      if (friction && ahead == 0 && (state.grip[0][i] != 0 || state.grip[1][i] != 0)) {
         sums.dissipated +=
             0.5 * k * (state.grip[0][i] * state.grip[0][i] + state.grip[1][i] * state.grip[1][i]);
         state.grip[0][i] = state.grip[1][i] = 0;
      }
      return;
   }
   const double rate = -state.column(9)[i];
   const double normal = std::max(0.0, k * depth + ground.damping * rate);
   force.z += normal;
   double lost = (normal - k * depth) * rate * dt;
   if (!friction) {
      sums.dissipated += lost;
      return;
   }
   const auto v = slipVelocity(assembly, state, i);
   double f[2];
   for (int j = 0; j < 2; ++j)
      f[j] = -k * (state.grip[j][i] + ahead * v[j]) - ground.damping * v[j];
   const double squared = f[0] * f[0] + f[1] * f[1], most = ground.friction * normal;
   if (squared > most * most) {
      const double part = most / std::sqrt(squared);
      for (double &one : f)
         one *= part;
      if (ahead == 0)
         for (int j = 0; j < 2; ++j) {
            const double held = -f[j] / k;
            lost += 0.5 * k * (state.grip[j][i] * state.grip[j][i] - held * held);
            state.grip[j][i] = held;
         }
   }
   sums.dissipated += lost - (f[0] * v[0] + f[1] * v[1]) * dt;
   const double h = assembly.halfHeight[i];
   force.x += f[0];
   force.y += f[1];
   torque.x += h * f[1];
   torque.y -= h * f[0];
}

/// Moves the friction springs along with the contact point.
inline void driftContact(const Assembly &assembly, State &state, std::int64_t i, double dt, Sums &sums)
{
   if (!(penetration(assembly, state, i) > 0))
      return;
   const auto v = slipVelocity(assembly, state, i);
   double stored = 0;
   for (std::size_t j = 0; j < 2; ++j) {
      const double old = state.grip[j][i], now = old + v[j] * dt;
      stored += now * now - old * old;
      state.grip[j][i] = now;
   }
   sums.dissipated -= 0.5 * assembly.ground.stiffness * stored;
}

} // namespace bonds
