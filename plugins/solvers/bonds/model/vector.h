// Three-vectors and quaternions of the solver's inner loop; the SDK brings no linear algebra.
#pragma once

#include <cmath>

namespace bonds {

struct Vec3
{
   double x = 0, y = 0, z = 0;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b)
{
   return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double squared(Vec3 a) { return dot(a, a); }
inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }

/// Unit quaternion, body to world, Hamilton product.
struct Quat
{
   double w = 1, x = 0, y = 0, z = 0;
};

inline Vec3 vec(Quat q) { return {q.x, q.y, q.z}; }
inline Quat operator*(Quat a, Quat b)
{
   return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
           a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

/// Rows of a rotation matrix.
struct Mat3
{
   Vec3 r0, r1, r2;
};

inline Vec3 operator*(const Mat3 &m, Vec3 a) { return {dot(m.r0, a), dot(m.r1, a), dot(m.r2, a)}; }
inline Vec3 transposed(const Mat3 &m, Vec3 a)
{
   return {m.r0.x * a.x + m.r1.x * a.y + m.r2.x * a.z, m.r0.y * a.x + m.r1.y * a.y + m.r2.y * a.z,
           m.r0.z * a.x + m.r1.z * a.y + m.r2.z * a.z};
}

/// The same rotation told in other axes.
inline Quat inAxes(const Mat3 &frame, Quat q)
{
   const Vec3 v = frame * vec(q);
   return {q.w, v.x, v.y, v.z};
}

/// Rotation matrix of a quaternion of any length but zero.
inline Mat3 matrix(Quat q)
{
   const double f = 2 / (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
   const double xx = f * q.x * q.x, yy = f * q.y * q.y, zz = f * q.z * q.z;
   const double xy = f * q.x * q.y, xz = f * q.x * q.z, yz = f * q.y * q.z;
   const double wx = f * q.w * q.x, wy = f * q.w * q.y, wz = f * q.w * q.z;
   return {{1 - yy - zz, xy - wz, xz + wy}, {xy + wz, 1 - xx - zz, yz - wx}, {xz - wy, yz + wx, 1 - xx - yy}};
}

/// The turn by the rotation vector `v`: cos and sin of half the angle by their series where that is exact to
/// rounding.
inline Quat exponential(Vec3 v)
{
   const double hh = 0.25 * dot(v, v); // square of half the angle
   if (hh < 0.01) {
      const double c = 1 - hh / 2 * (1 - hh / 12 * (1 - hh / 30 * (1 - hh / 56 * (1 - hh / 90))));
      const double s = 0.5 * (1 - hh / 6 * (1 - hh / 20 * (1 - hh / 42 * (1 - hh / 72 * (1 - hh / 110)))));
      return {c, s * v.x, s * v.y, s * v.z};
   }
   const double h = std::sqrt(hh), s = std::sin(h) / (2 * h);
   return {std::cos(h), s * v.x, s * v.y, s * v.z};
}

} // namespace bonds
