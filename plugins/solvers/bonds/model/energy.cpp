// Sums run in cell and bond order on one thread: they are read seldom, and their order fixes their bits.
#include "model/energy.h"

#include "model/contact.h"

#include <cmath>

namespace bonds {

namespace {

double energyOf(const Assembly &assembly, const State &state, const RestShape *rest, std::int64_t bond)
{
   const Relation r = relationOf(assembly, state, bond);
   if (rest)
      return bondEnergy(r, assembly.constants[bond], rest->separation(bond), rest->turn(bond));
   return bondEnergy(r, assembly.constants[bond], {assembly.lengthOf(bond), 0, 0}, {});
}

} // namespace

double kineticEnergy(const Assembly &assembly, const State &state)
{
   double sum = 0;
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      const Vec3 v = state.velocityOf(i), w = state.spinOf(i);
      sum += 0.5 * (assembly.mass[i] * dot(v, v) + dot(w, spinMomentum(assembly, i, state.turnOf(i), w)));
   }
   return sum;
}

Energies energies(const Assembly &assembly, const Couplings &couplings, const State &state,
                  const RestShape *rest)
{
   Energies out;
   out.kinetic = kineticEnergy(assembly, state);
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      const Vec3 u = state.displacementOf(i);
      if (assembly.hasGravity)
         out.gravity -=
             assembly.mass[i] * dot({assembly.gravity[0], assembly.gravity[1], assembly.gravity[2]}, u);
      if (!assembly.hasGround)
         continue;
      const double depth = std::max(0.0, penetration(assembly, state, i));
      out.contact += 0.5 * assembly.ground.stiffness * depth * depth;
      if (assembly.hasFriction)
         out.contact += 0.5 * assembly.ground.stiffness *
                        (state.grip[0][i] * state.grip[0][i] + state.grip[1][i] * state.grip[1][i]);
   }
   for (std::int64_t i = 0; i < assembly.links; ++i)
      out.elastic += energyOf(assembly, state, rest, i);
   for (const auto &coupling : couplings)
      out.elastic += coupling->energy(state, rest);
   return out;
}

Momenta momenta(const Assembly &assembly, const State &state)
{
   Momenta out;
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      const Vec3 p = assembly.mass[i] * state.velocityOf(i);
      const Vec3 at =
          Vec3{assembly.rest[0][i], assembly.rest[1][i], assembly.rest[2][i]} + state.displacementOf(i);
      out.linear = out.linear + p;
      out.angular = out.angular + cross(at, p) + spinMomentum(assembly, i, state.turnOf(i), state.spinOf(i));
   }
   return out;
}

Column strains(const Assembly &assembly, const State &state, const RestShape *rest)
{
   Column out(static_cast<std::size_t>(assembly.cells), 0);
   for (std::int64_t i = 0; i < assembly.links; ++i) {
      const double length = rest ? rest->d[0][i] : assembly.lengthOf(i);
      const Relation r = relationOf(assembly, state, i);
      const double strain = std::abs(r.u.x - length) / assembly.lengthOf(i);
      for (const std::int64_t cell : {assembly.a[i], assembly.b[i]})
         out[cell] = std::max(out[cell], strain);
   }
   return out;
}

std::int64_t worstBond(const Assembly &assembly, const State &state, const RestShape *rest)
{
   std::int64_t worst = -1;
   double most = -1;
   for (std::int64_t i = 0; i < assembly.links; ++i) {
      const double energy = energyOf(assembly, state, rest, i);
      if (!std::isfinite(energy))
         return i;
      if (energy > most) {
         most = energy;
         worst = i;
      }
   }
   return worst;
}

std::int64_t brokenCell(const Assembly &assembly, const State &state)
{
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      double sum = 0;
      for (int k = 0; k < 13; ++k)
         sum += std::abs(state.column(k)[i]);
      if (!std::isfinite(sum))
         return i;
   }
   return -1;
}

} // namespace bonds
