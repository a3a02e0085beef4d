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

/// What contact sees of a cell.
struct Touch
{
   double depth;                 // m, into the ground
   double rise;                  // m/s
   std::array<double, 2> slip;   // m/s, as slipVelocity()
   double halfHeight;            // m
   std::array<double *, 2> grip; // m, its friction springs; null without friction
};

inline Touch touchOf(const Assembly &assembly, State &state, std::int64_t i)
{
   Touch touch{penetration(assembly, state, i),
               state.column(9)[i],
               slipVelocity(assembly, state, i),
               assembly.halfHeight[i],
               {}};
   for (std::size_t j = 0; j < 2 && assembly.hasFriction; ++j)
      touch.grip[j] = &state.grip[j][i];
   return touch;
}

/// Adds the contact's force and torque. `ahead` is the time since the friction springs were last moved (inner
/// stages of a step); only with 0 may they slip. `dt` weights what is dissipated. Friction is Cundall
/// and Strack's: a tangential spring and damper whose force is cut at mu N, the spring being dragged along
/// (Geotechnique 29, 1979).
inline void addContact(const Ground &ground, const Touch &touch, double ahead, double dt, Vec3 &force,
                       Vec3 &torque, Sums &sums)
{
   const double k = ground.stiffness;
   const auto &grip = touch.grip;
   const bool friction = grip[0] != nullptr;
   if (!(touch.depth > 0)) {
      if (friction && ahead == 0 && (*grip[0] != 0 || *grip[1] != 0)) {
         sums.dissipated += 0.5 * k * (*grip[0] * *grip[0] + *grip[1] * *grip[1]);
         *grip[0] = *grip[1] = 0;
      }
      return;
   }
   const double rate = -touch.rise;
   const double normal = std::max(0.0, k * touch.depth + ground.damping * rate);
   force.z += normal;
   double lost = (normal - k * touch.depth) * rate * dt;
   if (!friction) {
      sums.dissipated += lost;
      return;
   }
   const auto &v = touch.slip;
   double f[2];
   for (std::size_t j = 0; j < 2; ++j)
      f[j] = -k * (*grip[j] + ahead * v[j]) - ground.damping * v[j];
   const double size = f[0] * f[0] + f[1] * f[1], most = ground.friction * normal;
   if (size > most * most) {
      const double part = most / std::sqrt(size);
      for (double &one : f)
         one *= part;
      if (ahead == 0)
         for (std::size_t j = 0; j < 2; ++j) {
            const double held = -f[j] / k;
            lost += 0.5 * k * (*grip[j] * *grip[j] - held * held);
            *grip[j] = held;
         }
   }
   sums.dissipated += lost - (f[0] * v[0] + f[1] * v[1]) * dt;
   const double h = touch.halfHeight;
   force.x += f[0];
   force.y += f[1];
   torque.x += h * f[1];
   torque.y -= h * f[0];
}

/// Moves the friction springs along with the contact point.
inline void driftContact(const Ground &ground, const Touch &touch, double dt, Sums &sums)
{
   if (!(touch.depth > 0))
      return;
   double stored = 0;
   for (std::size_t j = 0; j < 2; ++j) {
      const double old = *touch.grip[j], now = old + touch.slip[j] * dt;
      stored += now * now - old * old;
      *touch.grip[j] = now;
   }
   sums.dissipated -= 0.5 * ground.stiffness * stored;
}

} // namespace bonds
