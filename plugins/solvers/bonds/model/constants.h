// Bond constants from what the two cells are made of: half bonds in series, three beam theories.
#pragma once

#include "model/bond_kernel.h"

#include <algorithm>
#include <cmath>

namespace bonds {

enum class Beam { timoshenko, thesis, euler };

/// Constants that a bond of full length l would have if both its halves were like this one.
struct HalfConstants
{
   double axial = 0;
   double shear[2]{};   // along y, z: G A_s / l
   double bending[2]{}; // about y, z: E I / l
   double torsion = 0;  // G J / l
};

struct HalfBond : HalfConstants
{
   double dense[2]{}; // stiffness across in place of what the beam theory says; 0 = as it says
   double dampingRatio = 0;
   bool ownDamping = false; // `damping` instead of the ratio; it goes by the beam theory like stiffness
   HalfConstants damping;
   bool damped() const { return ownDamping || dampingRatio > 0; }
};

/// Saint-Venant torsion constant of a rectangle (Timoshenko and Goodier, Theory of Elasticity, article 109).
/// A square of side a gives 0.1406 a^4, not the polar a^4/6 (amoeba.md 4.1).
inline double torsionConstant(double a, double b)
{
   const double kPi = 3.14159265358979323846;
   if (a < b)
      std::swap(a, b);
   double sum = 31.0 / 32 * 1.0369277551433699; // of 1 / n^5 over odd n: 31/32 zeta(5)
   for (int n = 1; n <= 9; n += 2)              // beyond, tanh is 1 to rounding
      sum -= (1 - std::tanh(n * kPi * a / (2 * b))) / std::pow(n, 5);
   return a * b * b * b / 3 * (1 - 192 * b / (std::pow(kPi, 5) * a) * sum);
}

/// A beam of length l and cross section `width` (along y) x `height` (along z); A_s = 5/6 A.
inline HalfBond fromModulus(double youngsModulus, double poissonRatio, double l, double width, double height)
{
   const double area = width * height, shear = youngsModulus / (2 * (1 + poissonRatio));
   HalfBond half;
   half.axial = youngsModulus * area / l;
   half.shear[0] = half.shear[1] = 5.0 / 6 * shear * area / l;
   half.bending[0] = youngsModulus * area * height * height / (12 * l);
   half.bending[1] = youngsModulus * area * width * width / (12 * l);
   half.torsion = shear * torsionConstant(width, height) / l;
   return half;
}

/// Constants for a cell that has neighbours along and across the bond, in the plane that displaces across it.
/// Let a block shear by g while all its cells turn by t: bonds along x see the strain t, bonds along z see
/// g - t, and each bond stands for the section A and length l of a cell, so the energy per volume is
/// (kappa l / A) (t^2 + (g - t)^2) / 2. The cells turn to where it is least, t = g/2, and the block has
/// G = kappa l / (2 A): kappa = 2 G A / l, whatever the beam theory. In a homogeneous strain neighbours turn
/// alike, so bending and torsion play no part and stay as they are. A bar one cell thick has no second family
/// of bonds and would come out 2.4 times too stiff in shear.
inline void makeDense(HalfBond &half, int plane) { half.dense[plane] = 2 / (5.0 / 6) * half.shear[plane]; }

/// A wall one cell thick that is dense in `plane` alone twists as a plate: its two families of bonds share
/// G t^3/3 per width (Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, article 10), where a
/// single bar has Saint-Venant's constant. In terms of E w t^3/12, the bending of the wall's section.
inline void twistAsPlate(HalfBond &half, int plane, double poissonRatio)
{
   half.torsion = half.bending[plane] / (1 + poissonRatio);
}

/// Two springs of half length in series; two zeros give 0.
inline double series(double a, double b) { return a + b > 0 ? 2 * a * b / (a + b) : 0; }

/// Stiffness across the bond of a half: plane 0 displaces along y and bends about z, plane 1 along z and
/// about y.
inline double transverse(const HalfConstants &half, int plane, double l, Beam beam)
{
   const double shear = half.shear[plane], bend = 12 * half.bending[1 - plane] / (l * l);
   if (beam == Beam::thesis)
      return shear;
   if (beam == Beam::euler)
      return bend;
   return shear + bend > 0 ? shear * bend / (shear + bend) : 0;
}

/// Composite of halves a and b. The elastic centre s* = (l/4)(kb1 - kb2)/(kb1 + kb2) and 1/kappa* = 1/kappa -
/// s*^2/kb are the exact stepped beam (validation README, "What to know" 3). `mass` and `inertia` (per bond
/// axis) are the reduced ones of the free pair: a damping ratio is the bond's own, whatever the supports.
inline BondConstants compose(const HalfBond &a, const HalfBond &b, double l, Beam beam, bool stepped,
                             double mass, const double (&inertia)[3])
{
   const auto ofHalf = [](const HalfBond &half, double own, double k, double m) {
      return half.ownDamping ? own : 2 * half.dampingRatio * std::sqrt(k * m);
   };
   const auto damping = [&](double ownA, double ownB, double ka, double kb, double m) {
      return series(ofHalf(a, ownA, ka, m), ofHalf(b, ownB, kb, m));
   };
   BondConstants out;
   out.k[0] = series(a.axial, b.axial);
   out.d[0] = damping(a.damping.axial, b.damping.axial, a.axial, b.axial, mass);
   out.c[0] = series(a.torsion, b.torsion);
   out.e[0] = damping(a.damping.torsion, b.damping.torsion, a.torsion, b.torsion, inertia[0]);
   for (int i = 0; i < 2; ++i) {
      out.c[1 + i] = series(a.bending[i], b.bending[i]);
      out.e[1 + i] =
          damping(a.damping.bending[i], b.damping.bending[i], a.bending[i], b.bending[i], inertia[1 + i]);
   }
   for (int plane = 0; plane < 2; ++plane) {
      const bool dense = a.dense[plane] > 0 && b.dense[plane] > 0;
      const double ka = dense ? a.dense[plane] : transverse(a, plane, l, beam);
      const double kb = dense ? b.dense[plane] : transverse(b, plane, l, beam);
      out.k[1 + plane] = series(ka, kb);
      out.d[1 + plane] =
          damping(transverse(a.damping, plane, l, beam), transverse(b.damping, plane, l, beam), ka, kb, mass);
      const double ba = a.bending[1 - plane], bb = b.bending[1 - plane];
      if (!stepped || dense || beam == Beam::thesis || ba == bb || out.k[1 + plane] == 0 ||
          series(ba, bb) == 0)
         continue;
      const double s = l / 4 * (ba - bb) / (ba + bb);
      out.s[plane] = s;
      out.turn[plane] = s / l;
      out.k[1 + plane] = 1 / (1 / out.k[1 + plane] - s * s / series(ba, bb));
      // Dampings in proportion to stiffnesses stay so.
      const double d = out.d[1 + plane], e = out.e[2 - plane];
      if (a.ownDamping && b.ownDamping && d > 0 && s * s * d < e)
         out.d[1 + plane] = 1 / (1 / d - s * s / e);
   }
   return out;
}

} // namespace bonds
