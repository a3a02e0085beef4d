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
   Vec3 dv, wa, wb;    // velocity of b minus that of a, spins; only for damping
   bool small = false; // Law::small
};

/// State of a bond; vectors are in its middle frame but for those of a stepped beam's own.
struct BondPoint
{
   bool small = false; // turns count to first order: the middle frame is the bond's own
   Mat3 middle;
   Vec3 u;                // separation
   Vec3 stretch, phi;     // separation since rest, relative turn
   Vec3 v, half;          // sin(|phi|/2) n, tan(|phi|/4) n
   double w = 1;          // cos(|phi|/2)
   double s = 1, p = 0;   // S = s I + p v v
   double ds = 0, dp = 0; // rates of s and p per unit of v . phi'
   Vec3 f, c;             // force, moment conjugate to phi
   Step step;             // to the frame of a stepped beam, and there:
   Vec3 ownU, ownF;       // separation, force
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

} // namespace detail

/// Geometry alone, to first order in the turns.
inline BondPoint smallGeometry(const BondEnds &ends)
{
   BondPoint r;
   r.small = true;
   r.middle = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
   r.u = {ends.length, 0, 0};
   r.stretch = ends.displacement + cross(r.u, vec(ends.qa) + vec(ends.qb));
   r.phi = 2 * (vec(ends.qb) - vec(ends.qa));
   return r;
}

/// Geometry alone.
inline BondPoint bondGeometry(const BondEnds &ends)
{
   if (ends.small)
      return smallGeometry(ends);
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

/// Strain of the separation in the bond's own frame; `phi` and `stretch` are relative to the actuated rest.
/// Its digits are those of `stretch`.
inline Vec3 ownStrain(const BondPoint &r, const BondConstants &k, Vec3 phi, Vec3 stretch)
{
   return stretch + (r.small ? cross(Step::scaledTurn(k, phi), r.u) : Step(k, phi).change(r.u));
}

/// Rates of the generalised strains from velocities and spins in the middle frame (bond-model.md, Damping).
inline void strainRates(const BondPoint &r, const BondConstants &k, Vec3 dv, Vec3 wa, Vec3 wb, Vec3 &d,
                        Vec3 &phi, Vec3 &middleSpin)
{
   const Vec3 dw = wb - wa;
   phi = turned(r, dw);
   middleSpin = 0.5 * (wa + wb - cross(r.half, dw));
   d = r.step.to(dv + cross(r.u, middleSpin)) + cross(r.step.spin(k, phi), r.ownU);
}

/// Forces of the bond; `stretch` is the change of rest separation, `turn` the actuated rest rotation.
template<bool Damped>
inline BondPoint bondPoint(const BondEnds &ends, const BondConstants &k, Vec3 stretch, Vec3 turn)
{
   BondPoint r = bondGeometry(ends);
   const Vec3 phi = r.phi - turn;
   r.step = r.small ? Step() : Step(k, phi);
   r.ownU = r.step.to(r.u);
   r.ownF = scaled(k.k, ownStrain(r, k, phi, r.stretch - stretch));
   r.c = scaled(k.c, phi);
   if constexpr (Damped) {
      Vec3 dRate, phiRate, spin;
      strainRates(r, k, transposed(r.middle, ends.dv), transposed(r.middle, ends.wa),
                  transposed(r.middle, ends.wb), dRate, phiRate, spin);
      r.ownF = r.ownF + scaled(k.d, dRate);
      r.c = r.c + scaled(k.e, phiRate);
   }
   r.c = r.c + r.step.moments(k, cross(r.ownU, r.ownF));
   r.f = r.step.back(r.ownF);
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

/// forceChange() of Law::small: no force turns, no arm moves.
inline EndForces smallForceChange(const BondPoint &r, const BondConstants &k, Vec3 dv, Vec3 wa, Vec3 wb)
{
   Vec3 dd, y, spin;
   strainRates(r, k, dv, wa, wb, dd, y, spin);
   const Vec3 df = scaled(k.k, dd), dg = cross(df, r.u);
   const Vec3 dc = scaled(k.c, y) + Step::scaledTurn(k, cross(r.u, df));
   return {df, dc - 0.5 * dg, -dc - 0.5 * dg};
}

/// Change of force and torques, seen from a frame that stays, when the ends move by dv (b minus a) and spin
/// by wa and wb, all in the middle frame. The derivative of evaluate<false, true, true> in bond_kernel.h,
/// term by term; `k` may hold stiffness plus damping over a time, for implicit steps.
inline EndForces forceChange(const BondPoint &r, const BondConstants &k, Vec3 dv, Vec3 wa, Vec3 wb)
{
   if (r.small)
      return smallForceChange(r, k, dv, wa, wb);
   Vec3 dd, y, spin;
   strainRates(r, k, dv, wa, wb, dd, y, spin);
   const Vec3 ownDf = scaled(k.k, dd), moment = cross(r.ownU, r.ownF), da = 0.5 * Step::scaledTurn(k, y);
   const Vec3 df = r.step.back(ownDf - cross(r.step.spin(k, y), r.ownF));
   // The moments' change: by the moment, and by what a step of another size makes of it.
   const Vec3 dc = scaled(k.c, y) + r.step.moments(k, cross(dd, r.ownF) + cross(r.ownU, ownDf)) -
                   Step::scaledTurn(k, r.step.f * cross(da, moment)) -
                   (2 * r.step.f * dot(r.step.a, da)) * r.step.moments(k, moment);
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
