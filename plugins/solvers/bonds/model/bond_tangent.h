// The bond law with its exact derivative, for balances: forces, moments and how they change with every
// displacement and spin of both cells. Strains are formed from displacements since rest, not from places, so
// that a strain of 1e-15 keeps all its digits. Everything is in bond axes.
#pragma once

#include "model/bond_kernel.h"

namespace bonds {

/// Where the ends are, as far as a bond sees it.
struct BondEnds
{
   Vec3 displacement; // of b minus that of a, since rest
   double length = 0; // at rest
   Quat qa, qb;
   Vec3 dv, wa, wb; // velocity of b minus that of a, spins; only for damping
};

/// State of a bond; vectors are in its middle frame.
struct BondPoint
{
   Mat3 middle;
   Vec3 u;                // separation
   Vec3 stretch, phi;     // separation since rest, relative turn
   Vec3 v, half;          // sin(|phi|/2) n, tan(|phi|/4) n
   double w = 1;          // cos(|phi|/2)
   double s = 1, p = 0;   // S = s I + p v v
   double ds = 0, dp = 0; // rates of s and p per unit of v . phi'
   Vec3 f, c;             // force, moment conjugate to phi
   Vec3 g, h;             // f x u; what the torques share with opposite signs
};

namespace detail {

/// Rate of p per unit of v . phi', that is w dp/d(sin^2): the series of arcRatio below 0.1 rad.
inline double rateOfP(double nn, double w, double p, double ds)
{
   if (nn >= 0.01)
      return -(ds + p * w) / nn;
   const double slope =
       3.0 / 40 +
       nn * (10.0 / 112 +
             nn * (105.0 / 1152 + nn * (252.0 / 2816 + nn * (1155.0 / 13312 + nn * (858.0 / 10240)))));
   return -w * slope;
}

/// d and phi follow from displacement and turn; the same map takes their rates.
inline void couple(const BondConstants &k, Vec3 phi, Vec3 &d)
{
   d.y += k.s[0] * phi.z;
   d.z -= k.s[1] * phi.y;
}
/// Its transpose: what the transverse force adds to the moments.
inline void coupleBack(const BondConstants &k, Vec3 f, Vec3 &c)
{
   c.z += k.s[0] * f.y;
   c.y -= k.s[1] * f.z;
}

} // namespace detail

/// Geometry alone.
inline BondPoint bondGeometry(const BondEnds &ends)
{
   const Quat a = ends.qa;
   Quat b = ends.qb;
   BondPoint r;
   r.w = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
   if (r.w < 0) { // the shorter of the two relative rotations
      r.w = -r.w;
      b = {-b.w, -b.x, -b.y, -b.z};
   }
   const Quat m{a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z};
   r.v = a.w * vec(b) - b.w * vec(a) - cross(vec(a), vec(b));
   r.middle = matrix(m);
   // R^T e_x - e_x without taking 1 from the diagonal.
   const double f = 2 / (m.w * m.w + m.x * m.x + m.y * m.y + m.z * m.z);
   const Vec3 turned{-f * (m.y * m.y + m.z * m.z), r.middle.r0.y, r.middle.r0.z};
   r.stretch = transposed(r.middle, ends.displacement) + ends.length * turned;
   r.u = r.stretch + Vec3{ends.length, 0, 0};
   const double nn = dot(r.v, r.v);
   arcRatio(nn, r.w, r.s, r.p);
   r.phi = (2 * r.s) * r.v;
   r.half = (1 / (1 + r.w)) * r.v;
   r.ds = 0.5 * (1 / (1 + r.w) + r.p * r.w);
   r.dp = detail::rateOfP(nn, r.w, r.p, r.ds);
   return r;
}

/// S c with S = s I + p v v^T.
inline Vec3 turned(const BondPoint &r, Vec3 c) { return r.s * c + (r.p * dot(r.v, c)) * r.v; }

/// Rates of the generalised strains from velocities and spins in the middle frame (bond-model.md, Damping).
inline void strainRates(const BondPoint &r, const BondConstants &k, Vec3 dv, Vec3 wa, Vec3 wb, Vec3 &d,
                        Vec3 &phi, Vec3 &middleSpin)
{
   const Vec3 dw = wb - wa;
   phi = turned(r, dw);
   middleSpin = 0.5 * (wa + wb - cross(r.half, dw));
   d = dv + cross(r.u, middleSpin);
   detail::couple(k, phi, d);
}

/// Forces of the bond; `stretch` is the change of rest separation, `turn` the actuated rest rotation.
template<bool Damped>
inline BondPoint bondPoint(const BondEnds &ends, const BondConstants &k, Vec3 stretch, Vec3 turn)
{
   BondPoint r = bondGeometry(ends);
   const Vec3 phi = r.phi - turn;
   Vec3 d = r.stretch - stretch;
   detail::couple(k, phi, d);
   r.f = scaled(k.k, d);
   r.c = scaled(k.c, phi);
   if constexpr (Damped) {
      Vec3 dRate, phiRate, spin;
      strainRates(r, k, transposed(r.middle, ends.dv), transposed(r.middle, ends.wa),
                  transposed(r.middle, ends.wb), dRate, phiRate, spin);
      r.f = r.f + scaled(k.d, dRate);
      r.c = r.c + scaled(k.e, phiRate);
   }
   detail::coupleBack(k, r.f, r.c);
   r.g = cross(r.f, r.u);
   r.h = turned(r, r.c) - 0.5 * cross(r.g, r.half);
   return r;
}

/// Force on a, torques on a and b, or their changes.
struct EndForces
{
   Vec3 force, torqueA, torqueB;
};

inline EndForces endForces(const BondPoint &r)
{
   return {r.middle * r.f, r.middle * (r.h - 0.5 * r.g), r.middle * (-r.h - 0.5 * r.g)};
}

/// Change of force and torques, seen from a frame that stays, when the ends move by dv (b minus a) and spin
/// by wa and wb, all in the middle frame. The derivative of evaluate<false, true, true> in bond_kernel.h,
/// term by term; `k` may hold stiffness plus damping over a time, for implicit steps.
inline EndForces forceChange(const BondPoint &r, const BondConstants &k, Vec3 dv, Vec3 wa, Vec3 wb)
{
   Vec3 dd, y, spin;
   strainRates(r, k, dv, wa, wb, dd, y, spin);
   const Vec3 df = scaled(k.k, dd);
   Vec3 dc = scaled(k.c, y);
   detail::coupleBack(k, df, dc);
   const double a = dot(r.v, y), vc = dot(r.v, r.c);
   const Vec3 v1 = (0.5 / r.s) * y - (r.ds * a / r.s) * r.v; // change of v
   const double f = 1 / (1 + r.w);
   const Vec3 half1 = f * v1 + (0.5 * a * f * f) * r.v;
   const Vec3 dg = cross(df, r.u) + cross(r.f, dv + cross(r.u, spin));
   const Vec3 dS = (r.ds * a) * r.c + (r.dp * a * vc + r.p * dot(v1, r.c)) * r.v + (r.p * vc) * v1;
   const Vec3 dh = turned(r, dc) + dS - 0.5 * (cross(dg, r.half) + cross(r.g, half1));
   return {df + cross(spin, r.f), dh - 0.5 * dg + cross(spin, r.h - 0.5 * r.g),
           -dh - 0.5 * dg + cross(spin, -r.h - 0.5 * r.g)};
}

} // namespace bonds
