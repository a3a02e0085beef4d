// The generalised-alpha method: second order, stable at any step on linear problems, and as much numerical
// damping of what a step cannot resolve as is asked for (Chung and Hulbert, J. Appl. Mech. 60, 1993).
#pragma once

namespace bonds {

/// Weights for a spectral radius of 1 - damping at infinite frequency. 0 keeps the energy of linear motion
/// (the trapezoidal rule); 1 kills in one step what is too fast for it.
struct AlphaMethod
{
   explicit AlphaMethod(double damping)
   {
      const double radius = 1 - damping;
      mass = (2 * radius - 1) / (radius + 1);
      force = radius / (radius + 1);
      gamma = 0.5 - mass + force;
      beta = 0.25 * (1 - mass + force) * (1 - mass + force);
   }

   /// dv/dx and dv'/dx of the end of a step of length h by its increment x.
   double speedBy(double h) const { return gamma / (beta * h); }
   double rateBy(double h) const { return (1 - mass) / ((1 - force) * beta * h * h); }
   /// Local error of a step in position, in h^2 times the change of acceleration over it: the auxiliary
   /// acceleration is that at `mass - force` of a step later.
   double error() const { return 1.0 / 6 - beta - 0.5 * (mass - force); }
   /// The same in speed, in h times the change of that change.
   double speedError() const
   {
      const double shift = mass - force;
      return 1.0 / 6 - 0.25 + shift * shift - shift * (mass - 0.5);
   }

   double mass = 0, force = 0, beta = 0, gamma = 0; // alpha_m, alpha_f, beta, gamma of the paper
};

} // namespace bonds
