// Force and torques of one bond: the exact gradient of U = 1/2 d.K d + 1/2 phi.C phi in the middle frame, or
// for a stepped beam in one nearer to the stiffer end, for any rotation, with damping that acts on strain
// rates only; or that of the same U with strains linear in displacements and turns. Everything is in bond
// axes: x along the bond at rest.
#pragma once

#include "model/vector.h"

#include <array>

namespace bonds {

/// What turns do to a bond: all that they do, or less where that is asked for.
enum class Law {
   exact,
   simple, // without what keeps energy at large rotations
   small   // strains are linear: good for turns whose square is small
};

/// Stiffnesses of a bond (N/m; N m/rad) and their dampings. `s` moves the elastic centre of each bending
/// plane towards the softer half, which makes a stepped beam exact: the frame that strains are seen in is the
/// middle one turned back by `turn` = s / length of the relative turn (Step, below).
struct BondConstants
{
   double k[3]{};            // axial, shear y, shear z
   double c[3]{};            // torsion, bending about y, bending about z
   double s[2]{}, turn[2]{}; // m; parts, zero where a beam is the same at both ends
   double d[3]{}, e[3]{};
};

/// What a bond sees of its two cells.
struct Ends
{
   Vec3 separation; // b - a
   Quat qa, qb;     // of Law::small: 1 and half the rotation vector
   Vec3 dv;         // velocity of b minus that of a
   Vec3 wa, wb;
   double length = 0; // at rest; only Law::small asks
};

struct BondForces
{
   Vec3 force; // on a; b gets the opposite
   Vec3 torqueA, torqueB;
   double power = 0; // W dissipated
};

/// Middle frame and relative rotation.
struct Relation
{
   Mat3 middle;
   Vec3 u;    // separation in the middle frame
   Vec3 v;    // vector part of the relative quaternion, sin(|phi|/2) n
   Vec3 half; // tan(|phi|/4) n
   double s;  // x / sin x, x = |phi|/2
   double p;  // (1 - s) / sin^2 x
   Vec3 phi;
   bool small = false; // turns count to first order: the middle frame is the bond's own
   Vec3 arm;           // separation at rest; only then
};

/// x / sin x and (1 - x / sin x) / sin^2 x from sin^2 x and cos x; the series of arcsin below 0.1 rad is
/// exact to rounding.
inline void arcRatio(double nn, double w, double &s, double &p)
{
   if (nn < 0.01) {
      p = -(1.0 / 6 +
            nn * (3.0 / 40 + nn * (5.0 / 112 +
                                   nn * (35.0 / 1152 +
                                         nn * (63.0 / 2816 + nn * (231.0 / 13312 + nn * (143.0 / 10240)))))));
      s = 1 - nn * p;
   } else {
      const double n = std::sqrt(nn);
      s = std::atan2(n, w) / n;
      p = (1 - s) / nn;
   }
}

/// Rotation vector of a unit quaternion, the shorter of the two.
inline Vec3 logarithm(Quat q)
{
   const Vec3 v = q.w < 0 ? -vec(q) : vec(q);
   double s = 1, p = 0;
   arcRatio(dot(v, v), std::abs(q.w), s, p);
   return (2 * s) * v;
}

inline Relation relate(const Ends &ends)
{
   const Quat a = ends.qa;
   Quat b = ends.qb;
   double w = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
   if (w < 0) { // the shorter of the two relative rotations
      w = -w;
      b = {-b.w, -b.x, -b.y, -b.z};
   }
   Relation r;
   r.v = a.w * vec(b) - b.w * vec(a) - cross(vec(a), vec(b));
   r.middle = matrix({a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z});
   r.u = transposed(r.middle, ends.separation);
   arcRatio(dot(r.v, r.v), w, r.s, r.p);
   r.phi = (2 * r.s) * r.v;
   r.half = (1 / (1 + w)) * r.v;
   return r;
}

/// As relate(), to first order in the turns: the separation is what is left when the mean turn is taken out.
inline Relation relateSmall(const Ends &ends)
{
   Relation r{};
   r.middle = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
   r.small = true;
   r.arm = {ends.length, 0, 0};
   r.u = ends.separation + cross(r.arm, vec(ends.qa) + vec(ends.qb));
   r.phi = 2 * (vec(ends.qb) - vec(ends.qa));
   r.s = 1;
   return r;
}

/// The turn Q from vectors in the middle frame to those in the frame of a stepped beam. To first order it
/// adds s[0] phi_z and -s[1] phi_y to the transverse strains; being a turn, it leaves the length of a bond
/// that only bends as it is, where the sums alone would stretch it by half the square of s phi / length. The
/// turn is Cayley's of the vector, which differs from the exponential by a twelfth of its cube.
struct Step
{
   Vec3 a;       // half the turn's vector
   double f = 1; // 1 / (1 + a.a)

   static Vec3 scaledTurn(const BondConstants &k, Vec3 phi)
   {
      return {0, k.turn[1] * phi.y, k.turn[0] * phi.z};
   }
   Step() = default;
   Step(const BondConstants &k, Vec3 phi) : a(0.5 * scaledTurn(k, phi)), f(1 / (1 + dot(a, a))) {}

   /// Q v - v
   Vec3 change(Vec3 v) const
   {
      const Vec3 first = cross(a, v);
      return (2 * f) * (first + cross(a, first));
   }
   Vec3 to(Vec3 v) const { return v + change(v); }
   Vec3 back(Vec3 v) const
   {
      const Vec3 first = cross(a, v);
      return v + (2 * f) * (cross(a, first) - first);
   }
   /// Spin of Q by the rate of phi, and its transpose: moments by a moment.
   Vec3 spin(const BondConstants &k, Vec3 phiRate) const
   {
      const Vec3 rate = scaledTurn(k, phiRate);
      return f * (rate + cross(a, rate));
   }
   Vec3 moments(const BondConstants &k, Vec3 moment) const
   {
      return scaledTurn(k, f * (moment - cross(a, moment)));
   }
};

inline Vec3 scaled(const double (&k)[3], Vec3 a) { return {k[0] * a.x, k[1] * a.y, k[2] * a.z}; }

/// S c with S = s I + (1 - s) n n^T: from conjugate moments to torques.
inline Vec3 turned(const Relation &r, Vec3 c) { return r.s * c + (r.p * dot(r.v, c)) * r.v; }

/// Separation in the bond's own frame; `phi` is relative to the actuated rest.
inline Vec3 ownSeparation(const Relation &r, const BondConstants &k, Vec3 phi)
{
   return r.small ? r.u + cross(Step::scaledTurn(k, phi), r.arm) : Step(k, phi).to(r.u);
}

/// evaluate() for Law::small: every term is linear, so that the forces are one matrix times the state.
template<bool Damped>
inline void evaluateSmall(const Ends &ends, const BondConstants &k, Vec3 restD, Vec3 restPhi, BondForces &out)
{
   const Relation r = relateSmall(ends);
   const Vec3 phi = r.phi - restPhi;
   Vec3 f = scaled(k.k, ownSeparation(r, k, phi) - restD), c = scaled(k.c, phi);
   if constexpr (Damped) {
      const Vec3 phiRate = ends.wb - ends.wa;
      const Vec3 dRate =
          ends.dv + cross(r.arm, 0.5 * (ends.wa + ends.wb)) + cross(Step::scaledTurn(k, phiRate), r.arm);
      const Vec3 fd = scaled(k.d, dRate), cd = scaled(k.e, phiRate);
      out.power = dot(fd, dRate) + dot(cd, phiRate);
      f = f + fd;
      c = c + cd;
   }
   c = c + Step::scaledTurn(k, cross(r.arm, f));
   const Vec3 g = cross(f, r.arm);
   out.force = f;
   out.torqueA = c - 0.5 * g;
   out.torqueB = -c - 0.5 * g;
}

/// bond-model.md "Forces and torques", "Damping".
template<bool Damped, bool Coupled, Law kLaw>
inline void evaluate(const Ends &ends, const BondConstants &k, Vec3 restD, Vec3 restPhi, BondForces &out)
{
   if constexpr (kLaw == Law::small)
      return evaluateSmall<Damped>(ends, k, restD, restPhi, out);
   constexpr bool Exact = kLaw == Law::exact;
   const Relation r = relate(ends);
   const Vec3 phi = r.phi - restPhi;
   Step step;
   Vec3 u = r.u;
   if constexpr (Coupled) {
      step = Step(k, phi);
      u = step.to(u);
   }
   Vec3 f = scaled(k.k, u - restD);
   Vec3 c = scaled(k.c, phi);
   if constexpr (Damped) {
      const Vec3 wa = transposed(r.middle, ends.wa), wb = transposed(r.middle, ends.wb);
      const Vec3 dw = wb - wa;
      Vec3 mean = 0.5 * (wa + wb), phiRate = dw;
      if constexpr (Exact) {
         phiRate = turned(r, dw);
         mean = mean - 0.5 * cross(r.half, dw);
      }
      Vec3 dRate = transposed(r.middle, ends.dv) + cross(r.u, mean);
      if constexpr (Coupled)
         dRate = step.to(dRate) + cross(step.spin(k, phiRate), u);
      const Vec3 fd = scaled(k.d, dRate), cd = scaled(k.e, phiRate);
      out.power = dot(fd, dRate) + dot(cd, phiRate);
      f = f + fd;
      c = c + cd;
   }
   if constexpr (Coupled) {
      c = c + step.moments(k, cross(u, f));
      f = step.back(f);
   }
   const Vec3 g = cross(f, r.u);
   Vec3 h = c;
   if constexpr (Exact)
      h = turned(r, c) - 0.5 * cross(g, r.half);
   out.force = r.middle * f;
   out.torqueA = r.middle * (h - 0.5 * g);
   out.torqueB = r.middle * (-h - 0.5 * g);
}

/// J stored in a bond.
inline double bondEnergy(const Relation &r, const BondConstants &k, Vec3 restD, Vec3 restPhi)
{
   const Vec3 phi = r.phi - restPhi, d = ownSeparation(r, k, phi) - restD;
   return 0.5 * (dot(scaled(k.k, d), d) + dot(scaled(k.c, phi), phi));
}

/// J that a bond gains when its rest shape changes and its cells stay where they are.
inline double energyGain(const Relation &r, const BondConstants &k, const std::array<Vec3, 2> &from,
                         const std::array<Vec3, 2> &to)
{
   const Vec3 turning = from[1] - to[1], phi = r.phi - from[1];
   const Vec3 own = ownSeparation(r, k, phi), d = own - from[0];
   Vec3 moving = from[0] - to[0];
   if (dot(turning, turning) != 0)
      moving = moving + (ownSeparation(r, k, phi + turning) - own);
   return dot(scaled(k.k, moving), d + 0.5 * moving) + dot(scaled(k.c, turning), phi + 0.5 * turning);
}

} // namespace bonds
