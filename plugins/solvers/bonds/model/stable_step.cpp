// The highest eigenvalue of an assembly is at most that of its worst element (amoeba.md 4.4), for any way of
// sharing each cell's mass and inertia among its bonds. Shared in proportion to stiffness, separately per
// direction, the bound is exact for chains and 1.1 to 1.4 times the true frequency for blocks (shared evenly:
// up to 1.5, and far off for unlike neighbours).
#include "model/stable_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bonds {

namespace {

/// Total stiffness on each degree of freedom of each cell, world axes.
struct Load
{
   std::array<Column, 3> move, turn;
   CellForces stiffness, damping; // row sums of couplings; empty columns without any
};

/// Inverse of the share of mass (inertia) per unit of stiffness: share = stiffness / total * mass.
struct Shares
{
   const Assembly &assembly;
   const Load &load;

   double move(std::int64_t cell, int axis) const
   {
      if (axis < 3)
         return load.move[axis][cell] * assembly.inverseMass(cell, axis);
      return std::max({move(cell, 0), move(cell, 1), move(cell, 2)});
   }
   double turn(std::int64_t cell, int axis) const
   {
      if (axis < 3)
         return load.turn[axis][cell] * assembly.inverseInertia(cell, axis);
      return std::max({turn(cell, 0), turn(cell, 1), turn(cell, 2)});
   }
};

/// Stiffness plus damping as it weighs in at a step of `dt`: the shares must suit both.
double weighed(double k, double d, double dt) { return k + 2 * d / dt; }

/// Diagonal of a bond's matrix at its ends a and b, along and about its own axes.
struct Diagonal
{
   double move[3], turnA[3], turnB[3];
};

Diagonal diagonalOf(const BondConstants &k, double length, double dt)
{
   double s[3], r[3];
   for (int j = 0; j < 3; ++j) {
      s[j] = weighed(k.k[j], k.d[j], dt);
      r[j] = weighed(k.c[j], k.e[j], dt);
   }
   Diagonal out{{s[0], s[1], s[2]}, {r[0], 0, 0}, {r[0], 0, 0}};
   for (int plane = 0; plane < 2; ++plane) { // plane 0 bends about z, plane 1 about y
      const double armA = length / 2 + k.s[plane], armB = length / 2 - k.s[plane];
      out.turnA[2 - plane] = s[1 + plane] * armA * armA + r[2 - plane];
      out.turnB[2 - plane] = s[1 + plane] * armB * armB + r[2 - plane];
   }
   return out;
}

/// A coupling's eigenvalues are at most its row sum over its share of the mass (Gershgorin's theorem), a
/// bond's twice its stiffness over that: shared by half the row sum, both weigh the same.
void addCouplings(const Assembly &assembly, const Couplings &couplings, double dt, Load &load)
{
   for (CellForces *sums : {&load.stiffness, &load.damping})
      for (Column &column : *sums)
         column.assign(static_cast<std::size_t>(assembly.cells), 0);
   for (const auto &coupling : couplings)
      coupling->addRowSums(load.stiffness, load.damping);
   for (int k = 0; k < 6; ++k)
      for (std::int64_t i = 0; i < assembly.cells; ++i)
         (k < 3 ? load.move : load.turn)[k % 3][i] +=
             0.5 * weighed(load.stiffness[k][i], load.damping[k][i], dt);
}

/// Adds bonds, ground contacts and couplings.
Load loadOf(const Assembly &assembly, const Couplings &couplings, double dt)
{
   Load load;
   for (int k = 0; k < 3; ++k) {
      load.move[k].assign(static_cast<std::size_t>(assembly.cells), 0);
      load.turn[k].assign(static_cast<std::size_t>(assembly.cells), 0);
   }
   for (std::int64_t i = 0; i < assembly.links; ++i) {
      const int axis = assembly.axisOf(i);
      const Diagonal d = diagonalOf(assembly.constants[i], assembly.lengthOf(i), dt);
      for (int j = 0; j < 3; ++j) {
         const bool askew = axis == 3;
         const int world = (axis + j) % 3;
         const double move = askew ? std::max({d.move[0], d.move[1], d.move[2]}) : d.move[j];
         load.move[world][assembly.a[i]] += move;
         load.move[world][assembly.b[i]] += move;
         load.turn[world][assembly.a[i]] +=
             askew ? std::max({d.turnA[0], d.turnA[1], d.turnA[2]}) : d.turnA[j];
         load.turn[world][assembly.b[i]] +=
             askew ? std::max({d.turnB[0], d.turnB[1], d.turnB[2]}) : d.turnB[j];
      }
   }
   if (assembly.hasGround)
      for (std::int64_t i = 0; i < assembly.cells; ++i) {
         const double k = weighed(assembly.ground.stiffness, assembly.ground.damping, dt),
                      h = assembly.halfHeight[i];
         load.move[2][i] += k;
         for (int axis = 0; axis < 2 && assembly.hasFriction; ++axis) {
            load.move[axis][i] += k;
            load.turn[axis][i] += k * h * h;
         }
      }
   if (!couplings.empty())
      addCouplings(assembly, couplings, dt, load);
   return load;
}

/// Larger eigenvalue of [p r; r q].
double larger(double p, double q, double r)
{
   return 0.5 * (p + q) + std::sqrt(0.25 * (p - q) * (p - q) + r * r);
}

/// An oscillator: its squared frequency, and the most and the least that its damping rate (2 zeta omega) can
/// be.
struct Oscillator
{
   double w2 = 0, most = 0, least = 0;
};

/// Explicit midpoint and forward Euler gain energy in every vibration that is damped too little, at any step:
/// what the fastest may grow by in one.
constexpr double kGrowth = 1e-5;

/// Squared amplification of a step of forward Euler or midpoint, 1 + z and 1 + z + z^2/2, less 1: from
/// z = dt (-g/2 + i sqrt(w2 - g^2/4)).
double gained(Options::Integrator integrator, double w2, double g, double dt)
{
   if (integrator == Options::Integrator::forwardEuler)
      return dt * (w2 * dt - g);
   return dt * (-g + dt * (0.5 * g * g + dt * (-0.5 * g * w2 + dt * 0.25 * w2 * w2)));
}

/// Largest step at which the oscillator does not grow, nor any that is slower and damped in proportion: along
/// these the gain changes its sign once.
double limitOf(const Oscillator &of, Options::Integrator integrator)
{
   const auto &[w2, g, least] = of;
   if (!(w2 > 0) && !(g > 0))
      return std::numeric_limits<double>::infinity();
   // Runge-Kutta 4 holds within 2.78 of the origin on the left (2.828 on the imaginary, 2.785 on the real
   // axis).
   const double farthest = 0.5 * g + std::sqrt(0.25 * g * g + w2);
   if (integrator == Options::Integrator::rungeKutta)
      return 2.78 / farthest;
   if (integrator == Options::Integrator::midpoint || integrator == Options::Integrator::forwardEuler) {
      double low = 0, high = 2 / farthest; // where both end on the real axis
      for (int halving = 0; halving < 40; ++halving) {
         const double middle = 0.5 * (low + high);
         (gained(integrator, w2, least, middle) > 2 * kGrowth ? high : low) = middle;
      }
      return low;
   }
   // Semi-implicit Euler, Verlet: w2 dt^2 + 2 g dt < 4.
   return 4 / (g + std::sqrt(g * g + 4 * w2));
}

/// Least damping in proportion to stiffness (s) of all that is elastic: what every vibration has at least.
double leastDamping(const Assembly &assembly, const Couplings &couplings)
{
   if (!couplings.empty()) // their matrices are known by row sums only
      return 0;
   double least = std::numeric_limits<double>::infinity();
   const auto look = [&](double k, double d) {
      if (k > 0)
         least = std::min(least, d / k);
   };
   for (std::int64_t i = 0; i < assembly.links; ++i) {
      const BondConstants &k = assembly.constants[i];
      for (int j = 0; j < 3; ++j) {
         look(k.k[j], k.d[j]);
         look(k.c[j], k.e[j]);
      }
   }
   if (assembly.hasGround)
      look(assembly.ground.stiffness, assembly.ground.damping);
   return std::isfinite(least) ? least : 0;
}

/// Highest eigenvalues of one bond's stiffness and damping with the masses shared to it.
void bondEigenvalues(const Assembly &assembly, const Shares &shares, std::int64_t i, double dt, double &w2,
                     double &g)
{
   const int axis = assembly.axisOf(i);
   const BondConstants &k = assembly.constants[i];
   const Diagonal d = diagonalOf(k, assembly.lengthOf(i), dt);
   const std::int64_t a = assembly.a[i], b = assembly.b[i];
   const bool askew = axis == 3;
   const auto share = [](double total, double own) { return own > 0 ? total / own : 0; };
   double moveA[3], moveB[3], turnA[3], turnB[3];
   for (int j = 0; j < 3; ++j) {
      const int world = askew ? 3 : (axis + j) % 3;
      const double own = askew ? std::max({d.move[0], d.move[1], d.move[2]}) : d.move[j];
      moveA[j] = share(shares.move(a, world), own);
      moveB[j] = share(shares.move(b, world), own);
      turnA[j] =
          share(shares.turn(a, world), askew ? std::max({d.turnA[0], d.turnA[1], d.turnA[2]}) : d.turnA[j]);
      turnB[j] =
          share(shares.turn(b, world), askew ? std::max({d.turnB[0], d.turnB[1], d.turnB[2]}) : d.turnB[j]);
   }
   w2 = std::max(k.k[0] * (moveA[0] + moveB[0]), k.c[0] * (turnA[0] + turnB[0]));
   g = std::max(k.d[0] * (moveA[0] + moveB[0]), k.e[0] * (turnA[0] + turnB[0]));
   for (int plane = 0; plane < 2; ++plane) {
      const int across = 1 + plane, about = 2 - plane;
      const double armA = assembly.lengthOf(i) / 2 + k.s[plane], armB = assembly.lengthOf(i) / 2 - k.s[plane];
      const double shear =
          moveA[across] + moveB[across] + armA * armA * turnA[about] + armB * armB * turnB[about];
      const double bend = turnA[about] + turnB[about], both = armA * turnA[about] - armB * turnB[about];
      w2 = std::max(
          w2, larger(k.k[across] * shear, k.c[about] * bend, std::sqrt(k.k[across] * k.c[about]) * both));
      g = std::max(
          g, larger(k.d[across] * shear, k.e[about] * bend, std::sqrt(k.d[across] * k.e[about]) * both));
   }
}

/// The bound that couplings set, where it is below that of `out`; `limit` takes squared frequency and
/// damping.
template<typename Limit>
void boundCouplings(const Assembly &assembly, const Limit &limit, const Load &load, const Shares &shares,
                    double dt, StableStep &out)
{
   for (std::int64_t i = 0; i < assembly.cells; ++i)
      for (int k = 0; k < 6; ++k) {
         const double stiffness = load.stiffness[k][i], damping = load.damping[k][i];
         const double own = 0.5 * weighed(stiffness, damping, dt);
         if (!(own > 0))
            continue;
         const double share = (k < 3 ? shares.move(i, k) : shares.turn(i, k - 3)) / own;
         if (const double step = limit(stiffness * share, damping * share); step < out.step)
            out = {step, -1, i};
      }
}

/// A bound for any `dt` > 0, which only steers how the masses are shared.
StableStep boundAt(const Assembly &assembly, const Options &options, const Couplings &couplings, double dt)
{
   const Load load = loadOf(assembly, couplings, dt);
   const Shares shares{assembly, load};
   const double least = leastDamping(assembly, couplings);
   const auto limit = [&](double w2, double g) {
      return limitOf({w2, g + assembly.drag, least * w2 + assembly.drag}, options.integrator);
   };
   StableStep out{std::numeric_limits<double>::infinity(), -1, -1};
   for (std::int64_t i = 0; i < assembly.links; ++i) {
      double w2 = 0, g = 0;
      bondEigenvalues(assembly, shares, i, dt, w2, g);
      if (const double step = limit(w2, g); step < out.step)
         out = {step, i, -1};
   }
   if (!couplings.empty())
      boundCouplings(assembly, limit, load, shares, dt, out);
   if (!assembly.hasGround)
      return out;
   const double k = assembly.ground.stiffness, c = assembly.ground.damping, own = weighed(k, c, dt);
   for (std::int64_t i = 0; i < assembly.cells && own > 0; ++i) {
      double worst = shares.move(i, 2) / own;
      for (int axis = 0; axis < 2 && assembly.hasFriction;
           ++axis) // the contact point moves and turns with the cell
         worst = std::max(worst, (shares.move(i, axis) + shares.turn(i, 1 - axis)) / own);
      if (const double step = limit(k * worst, c * worst); step < out.step)
         out = {step, -1, i};
   }
   return out;
}

} // namespace

double longestStep(const Assembly &assembly, const Options &options, const Couplings &couplings, double w2,
                   double g)
{
   const double least = leastDamping(assembly, couplings);
   const double step = limitOf({w2, g + assembly.drag, least * w2 + assembly.drag}, options.integrator);
   return std::min(step, kFreeStep);
}

StableStep stableStep(const Assembly &assembly, const Options &options, const Couplings &couplings)
{
   StableStep best = boundAt(assembly, options, couplings, std::numeric_limits<double>::max());
   for (int pass = 0; pass < 3 && std::isfinite(best.step); ++pass) {
      const StableStep next = boundAt(assembly, options, couplings, best.step > 0 ? best.step : 1e-9);
      if (next.step > best.step)
         best = next;
   }
   if (!std::isfinite(best.step)) {
      best.step = assembly.drag > 0 ? std::min(kFreeStep, 2 / assembly.drag) : kFreeStep;
   }
   return best;
}

} // namespace bonds
