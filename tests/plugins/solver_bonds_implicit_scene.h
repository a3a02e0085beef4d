// What tests of implicit motion share: settings, an oscillator with its exact motion, Euler's top.
#pragma once

#include "solver_bonds_equilibrium_scene.h"

namespace diatom::test {

inline const Props kAluminium{{"density", 2700}, {"youngs_modulus", 69e9}, {"poisson_ratio", 0.33}};

inline SolverChoice implicit(double numericalDamping, double tolerance = 1e-3)
{
   SolverChoice choice;
   choice.integrator = "implicit";
   choice.numericalDamping = numericalDamping;
   choice.stepTolerance = tolerance;
   return choice;
}

/// Two cells of rubber, the first held, the second free along the bond alone, set off with a speed.
struct Oscillator
{
   double dampingRatio = 0;
   static constexpr double kEdge = 1e-3, kDensity = 1000, kModulus = 1e6, kSpeed = 1e-3;

   Props material() const
   {
      return {{"density", kDensity},
              {"youngs_modulus", kModulus},
              {"poisson_ratio", 0.3},
              {"damping_ratio", dampingRatio}};
   }
   HandScene scene() const
   {
      HandScene out(kEdge);
      out.addMaterial(material());
      out.addBlock(2, 1, 1);
      out.link();
      out.fix(0);
      out.fix(1, 62);
      out.addRow("velocity", {kSpeed, 0, 0, 0, 0, 0}, 1);
      if (dampingRatio > 0)
         out.effects.push_back("damping");
      return out;
   }
   double stiffness() const { return kModulus * kEdge; }
   double mass() const { return kDensity * kEdge * kEdge * kEdge; }
   double omega() const { return std::sqrt(stiffness() / mass()); }
   double amplitude() const { return kSpeed / omega(); }
   double energy() const { return 0.5 * mass() * kSpeed * kSpeed; }
   /// The bond's damping is told by the reduced mass of the free pair.
   double decay() const { return dampingRatio * std::sqrt(stiffness() * mass() / 2) / mass(); }
   double exact(double time) const
   {
      const double w = std::sqrt(omega() * omega() - decay() * decay());
      return kSpeed / w * std::exp(-decay() * time) * std::sin(w * time);
   }
   static double displacement(Run &run) { return run.read("position")[3] - kEdge; }
};

/// Largest difference of `count` numbers from the `first` on, over the largest of them.
inline double difference(const std::vector<double> &a, const std::vector<double> &b, std::size_t first,
                         std::size_t count)
{
   double worst = 0, size = 0;
   for (std::size_t i = first; i < first + count; ++i) {
      worst = std::max(worst, std::abs(a[i] - b[i]));
      size = std::max(size, std::abs(b[i]));
   }
   return worst / size;
}

/// Attitude (w x y z) of a free box after a time, from Euler's equations in its own axes.
inline std::vector<double> tumble(const std::vector<double> &extent, const double (&spin)[3], double until)
{
   using Values = std::array<double, 7>; // quaternion, spin in the box's axes
   const auto square = [&](int k) {
      return extent[static_cast<std::size_t>(k % 3)] * extent[static_cast<std::size_t>(k % 3)];
   };
   const double inertia[3] = {square(1) + square(2), square(2) + square(0), square(0) + square(1)};
   const auto rate = [&](const Values &y) {
      const double *q = y.data(), *w = y.data() + 4;
      return Values{-0.5 * (q[1] * w[0] + q[2] * w[1] + q[3] * w[2]),
                    0.5 * (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]),
                    0.5 * (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]),
                    0.5 * (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]),
                    (inertia[1] - inertia[2]) / inertia[0] * w[1] * w[2],
                    (inertia[2] - inertia[0]) / inertia[1] * w[2] * w[0],
                    (inertia[0] - inertia[1]) / inertia[2] * w[0] * w[1]};
   };
   const auto plus = [](Values a, const Values &b, double f) {
      for (std::size_t k = 0; k < a.size(); ++k)
         a[k] += f * b[k];
      return a;
   };
   Values y{1, 0, 0, 0, spin[0], spin[1], spin[2]};
   constexpr int kSteps = 100'000;
   const double h = until / kSteps;
   for (int n = 0; n < kSteps; ++n) {
      const Values a = rate(y), b = rate(plus(y, a, h / 2)), c = rate(plus(y, b, h / 2)),
                   d = rate(plus(y, c, h));
      y = plus(plus(plus(plus(y, a, h / 6), b, h / 3), c, h / 3), d, h / 6);
   }
   return {y[0], y[1], y[2], y[3]};
}

} // namespace diatom::test
