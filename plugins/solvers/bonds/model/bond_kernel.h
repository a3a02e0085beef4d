// Force and torques of one bond: the exact gradient of U = 1/2 d.K d + 1/2 phi.C phi in the middle frame, for
// any rotation, with damping that acts on strain rates only. Everything is in bond axes: x along the bond at
// rest.
#pragma once

#include "model/vector.h"

namespace bonds {

/// Stiffnesses of a bond (N/m; N m/rad) and their dampings. `s` moves the elastic centre of each bending
/// plane towards the softer half: the transverse strains are u_y + s[0] phi_z and u_z - s[1] phi_y, which
/// makes a stepped beam exact.
struct BondConstants
{
   double k[3]{}; // axial, shear y, shear z
   double c[3]{}; // torsion, bending about y, bending about z
   double s[2]{}; // m
   double d[3]{}, e[3]{};
};

/// What a bond sees of its two cells.
struct Ends
{
   Vec3 separation; // b - a
   Quat qa, qb;
   Vec3 dv; // velocity of b minus that of a
   Vec3 wa, wb;
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

/// Generalised strains: d (with the stepped coupling) and phi, both relative to the actuated rest.
template<bool Coupled>
inline void strains(const Relation &r, const BondConstants &k, Vec3 restD, Vec3 restPhi, Vec3 &d, Vec3 &phi)
{
   d = r.u - restD;
   phi = r.phi - restPhi;
   if constexpr (Coupled) {
      d.y += k.s[0] * phi.z;
      d.z -= k.s[1] * phi.y;
   }
}

inline Vec3 scaled(const double (&k)[3], Vec3 a) { return {k[0] * a.x, k[1] * a.y, k[2] * a.z}; }

/// S c with S = s I + (1 - s) n n^T: from conjugate moments to torques.
inline Vec3 turned(const Relation &r, Vec3 c) { return r.s * c + (r.p * dot(r.v, c)) * r.v; }

/// bond-model.md "Forces and torques", "Damping". Exact = false drops what keeps energy at large rotations.
template<bool Damped, bool Coupled, bool Exact>
inline void evaluate(const Ends &ends, const BondConstants &k, Vec3 restD, Vec3 restPhi, BondForces &out)
{
   const Relation r = relate(ends);
   Vec3 d, phi;
   strains<Coupled>(r, k, restD, restPhi, d, phi);
   Vec3 f = scaled(k.k, d);
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
      if constexpr (Coupled) {
         dRate.y += k.s[0] * phiRate.z;
         dRate.z -= k.s[1] * phiRate.y;
      }
      const Vec3 fd = scaled(k.d, dRate), cd = scaled(k.e, phiRate);
      out.power = dot(fd, dRate) + dot(cd, phiRate);
      f = f + fd;
      c = c + cd;
   }
   if constexpr (Coupled) {
      c.z += k.s[0] * f.y;
      c.y -= k.s[1] * f.z;
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
   Vec3 d, phi;
   strains<true>(r, k, restD, restPhi, d, phi);
   return 0.5 * (dot(scaled(k.k, d), d) + dot(scaled(k.c, phi), phi));
}

} // namespace bonds
