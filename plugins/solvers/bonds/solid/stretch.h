// The axial stretch of a bond as its middle frame sees it, with its exact first and second derivatives.
#pragma once

#include "model/bond_tangent.h"

namespace bonds {

/// In the axes that the ends were given in. Moving a by dp_a and turning it by the world rotation da, and
/// likewise b, changes the stretch by along . (dp_b - dp_a) + turnA . da + turnB . db.
struct Stretch
{
   double stretch = 0; // m, since rest
   Vec3 along, turnA, turnB;
};

/// With m the middle frame, u = m^T (p_b - p_a), e its first axis, g = e x u and h = tan(|phi|/4) n: the
/// frame turns by ((da + db) - h x (db - da)) / 2 (bond-model.md, "Damping"), so that u.e changes by m e .
/// (dp_b - dp_a) + m (g + g x h) . da / 2 + m (g - g x h) . db / 2.
/// Formed from the displacement since rest, so that small stretches keep their digits.
inline Stretch stretchOf(const BondEnds &ends)
{
   const Vec3 displacement = ends.displacement;
   const double length = ends.length;
   const Quat a = ends.qa;
   Quat b = ends.qb;
   double w = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
   const double sign = w < 0 ? -1 : 1; // the shorter of the two relative rotations
   w *= sign;
   b = {sign * b.w, sign * b.x, sign * b.y, sign * b.z};
   const Vec3 half = (1 / (1 + w)) * (a.w * vec(b) - b.w * vec(a) - cross(vec(a), vec(b)));
   const Quat m{a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z};
   const Mat3 middle = matrix(m);
   const double shrink = 2 * (m.y * m.y + m.z * m.z) / (m.w * m.w + m.x * m.x + m.y * m.y + m.z * m.z);
   const Vec3 along{middle.r0.x, middle.r1.x, middle.r2.x};
   const Vec3 u = transposed(middle, {displacement.x + length, displacement.y, displacement.z});
   const Vec3 g{0, -u.z, u.y}, gh = cross(g, half);
   return {dot(along, displacement) - length * shrink, along, middle * (0.5 * (g + gh)),
           middle * (0.5 * (g - gh))};
}

/// Second derivative: change of (along, turnA, turnB) when b moves by `move` against a and the ends turn.
inline Stretch stretchChange(const BondPoint &r, Vec3 move, Vec3 spinA, Vec3 spinB)
{
   const Vec3 e{1, 0, 0}, h = r.half, g{0, -r.u.z, r.u.y};
   const Vec3 sa = transposed(r.middle, spinA), sb = transposed(r.middle, spinB), difference = sb - sa;
   const Vec3 turn = 0.5 * (sa + sb - cross(h, difference));
   // The rotation vector changes by S (sb - sa); of tan(|phi|/4) n remains (1 + h.h)/4 in every direction.
   const Vec3 dh = (0.25 * (1 + dot(h, h))) * difference;
   const Vec3 du = transposed(r.middle, move) + cross(r.u, turn), dg = cross(e, du);
   const Vec3 dgh = cross(dg, h) + cross(g, dh), gh = cross(g, h);
   return {0, r.middle * cross(turn, e), r.middle * (0.5 * (cross(turn, g + gh) + dg + dgh)),
           r.middle * (0.5 * (cross(turn, g - gh) + dg - dgh))};
}

} // namespace bonds
