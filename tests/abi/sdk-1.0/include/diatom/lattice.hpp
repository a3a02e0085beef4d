// What the author of a lattice reads. A lattice is data: sites that repeat, a shape, and the kind of contact
// by which the lattice holds its cells together. Faces, the rotations of a cell and all contacts follow from
// the geometry here.
//
//    static diatom::sdk::Lattice kelvin(const diatom::sdk::Values &)
//    {
//       ...                      // fill in a Lattice; throw a Failure when the values make no lattice
//    }
//    DIATOM_LATTICE(kelvin)
//
// Lengths are lattice units, by custom the edge of the cell; the user's pitch and aspect are applied by the
// host.
#pragma once

#include <diatom/abi/lattice.h>
#include <diatom/plugin.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace diatom::sdk {
inline namespace v1 {

/// Points closer than this are one, in lattice units.
inline constexpr double kLatticeTolerance = 1e-7;

struct Vec
{
   double x = 0, y = 0, z = 0;
   friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
   friend Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
   friend Vec operator*(double k, Vec a) { return {k * a.x, k * a.y, k * a.z}; }
   friend double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
   friend Vec cross(Vec a, Vec b)
   {
      return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
   }
   friend double length(Vec a) { return std::sqrt(dot(a, a)); }
   friend bool same(Vec a, Vec b) { return length(a - b) < kLatticeTolerance; }
};

/// A rotation, as a unit quaternion.
struct Turn
{
   double w = 1, x = 0, y = 0, z = 0;
   Vec operator()(Vec v) const
   {
      const Vec axis{x, y, z}, t = 2 * cross(axis, v);
      return v + w * t + cross(axis, t);
   }
};

/// By so many degrees about an axis, counter-clockwise when the axis points at the viewer.
inline Turn turn(Vec axis, double degrees)
{
   const double half = degrees * std::acos(-1.0) / 360;
   const Vec a = (std::sin(half) / length(axis)) * axis;
   return {std::cos(half), a.x, a.y, a.z};
}

/// A step from cell to cell, in indices.
struct Step
{
   std::int32_t i = 0, j = 0, k = 0;
};

/// Kinds of contact between two cells: they share a whole face, else a whole edge, else a corner.
enum class Touch : std::int32_t {
   face = DIATOM_CONTACT_FACE,
   edge = DIATOM_CONTACT_EDGE,
   vertex = DIATOM_CONTACT_VERTEX
};

/// A convex polyhedron about the origin; made by hull().
struct Shape
{
   std::vector<Vec> vertices;
   std::vector<std::vector<std::int32_t>>
       faces; // counter-clockwise from outside, smallest vertex number first
};

/// Everything the author says about a lattice. Sites: see diatom_motif in abi/lattice.h.
struct Lattice
{
   std::array<std::int32_t, 3> period{1, 1, 1};                        // sites repeat after so many indices
   std::array<Vec, 3> basis{Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}}; // the step per index i, j, k
   std::vector<Vec> offset{Vec{}};        // one per site, added to basis times index
   std::vector<Turn> orientation;         // one per site; empty = no site is turned
   std::vector<Shape> shape;              // one for all sites, or several and:
   std::vector<std::int32_t> shapeOfSite; // one number per site; empty = all have shape 0
   Touch touch = Touch::face;             // the contact by which the lattice holds cells together
   std::function<bool(std::int32_t site, Step step, Touch contact)>
       joined;                        // in place of touch, when it is not enough
   std::vector<Step> supercellStep;   // one per site: direction of bricks; empty = no super-cells
   std::int32_t supercellLongest = 0; // 0 = unlimited
   std::int32_t supercellDefault = 1;
};

/// The point with all choices of signs: the 8 corners of a box, say.
inline std::vector<Vec> signs(Vec p)
{
   std::vector<Vec> points;
   for (int bits = 0; bits < 8; ++bits) {
      const Vec v{bits & 4 ? -p.x : p.x, bits & 2 ? -p.y : p.y, bits & 1 ? -p.z : p.z};
      if (std::none_of(points.begin(), points.end(), [&](Vec q) { return same(q, v); }))
         points.push_back(v);
   }
   return points;
}

/// The point with all permutations and signs of its coordinates.
inline std::vector<Vec> form(Vec p)
{
   std::vector<Vec> points;
   for (const Vec q : {p, Vec{p.y, p.z, p.x}, Vec{p.z, p.x, p.y}, Vec{p.x, p.z, p.y}, Vec{p.y, p.x, p.z},
                       Vec{p.z, p.y, p.x}})
      for (const Vec v : signs(q))
         if (std::none_of(points.begin(), points.end(), [&](Vec known) { return same(known, v); }))
            points.push_back(v);
   return points;
}

/// The corners, in the order given, with the faces of their convex hull. Every point must be a corner.
inline Shape hull(std::vector<Vec> points)
{
   Shape shape{std::move(points), {}};
   const auto &p = shape.vertices;
   const auto count = static_cast<std::int32_t>(p.size());
   std::vector<bool> used(p.size(), false);

   const auto addFace = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
      Vec normal = cross(p[b] - p[a], p[c] - p[a]);
      if (length(normal) < kLatticeTolerance)
         return;
      normal = (1 / length(normal)) * normal;
      double above = 0, below = 0;
      std::vector<std::int32_t> face;
      for (std::int32_t i = 0; i < count; ++i) {
         const double height = dot(normal, p[i] - p[a]);
         above = std::max(above, height);
         below = std::min(below, height);
         if (std::abs(height) < kLatticeTolerance)
            face.push_back(i);
      }
      // A face is found once for every three of its corners: only the three smallest numbers count.
      const bool inside = above > kLatticeTolerance && below < -kLatticeTolerance;
      if (inside || face[0] != a || face[1] != b || face[2] != c)
         return;
      if (above > kLatticeTolerance)
         normal = -1 * normal;
      Vec centre;
      for (const auto i : face) {
         centre = centre + (1.0 / static_cast<double>(face.size())) * p[i];
         used[i] = true;
      }
      const Vec u = p[a] - centre, v = cross(normal, u);
      const auto angle = [&](std::int32_t i) {
         const double radians = std::atan2(dot(v, p[i] - centre), dot(u, p[i] - centre));
         return radians < -kLatticeTolerance ? radians + 2 * std::acos(-1.0) : radians;
      };
      std::sort(face.begin(), face.end(), [&](auto i, auto j) { return angle(i) < angle(j); });
      shape.faces.push_back(std::move(face));
   };
   for (std::int32_t a = 0; a < count; ++a)
      for (std::int32_t b = a + 1; b < count; ++b)
         for (std::int32_t c = b + 1; c < count; ++c)
            addFace(a, b, c);

   for (std::int32_t i = 0; i < count; ++i)
      if (!used[i])
         throw Failure(DIATOM_BAD_INPUT,
                       "point " + std::to_string(i) + " of the shape is not a corner of its hull");
   return shape;
}

/// Vertex numbers of every face, edge or vertex of a shape. Edges are numbered in order of first appearance
/// when walking the faces.
inline std::vector<std::vector<std::int32_t>> features(const Shape &shape, Touch kind)
{
   if (kind == Touch::face)
      return shape.faces;
   std::vector<std::vector<std::int32_t>> list;
   if (kind == Touch::vertex) {
      for (std::size_t i = 0; i < shape.vertices.size(); ++i)
         list.push_back({static_cast<std::int32_t>(i)});
      return list;
   }
   for (const auto &face : shape.faces)
      for (std::size_t i = 0; i < face.size(); ++i) {
         const auto a = face[i], b = face[(i + 1) % face.size()];
         std::vector<std::int32_t> edge{std::min(a, b), std::max(a, b)};
         if (std::find(list.begin(), list.end(), edge) == list.end())
            list.push_back(std::move(edge));
      }
   return list;
}

namespace detail {

/// Right-handed orthonormal axes: the first along a, the third along a x b.
inline std::array<Vec, 3> axes(Vec a, Vec b)
{
   const Vec n = cross(a, b), e1 = (1 / length(a)) * a, e3 = (1 / length(n)) * n;
   return {e1, cross(e3, e1), e3};
}

/// The rotation from one set of axes to another. Components whose square is a multiple of 1/4 (turns by 30
/// degrees and its multiples about the usual axes) are made exact; w >= 0, and for half turns the first other
/// component > 0.
inline Turn between(const std::array<Vec, 3> &from, const std::array<Vec, 3> &to)
{
   double m[3][3] = {};
   for (int k = 0; k < 3; ++k) {
      const double f[3] = {from[k].x, from[k].y, from[k].z}, t[3] = {to[k].x, to[k].y, to[k].z};
      for (int row = 0; row < 3; ++row)
         for (int column = 0; column < 3; ++column)
            m[row][column] += t[row] * f[column];
   }
   // Outer product 4 q q^T in terms of the matrix; its row with the largest diagonal is q but for its length.
   const double outer[4][4] = {
       {1 + m[0][0] + m[1][1] + m[2][2], m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]},
       {m[2][1] - m[1][2], 1 + m[0][0] - m[1][1] - m[2][2], m[0][1] + m[1][0], m[0][2] + m[2][0]},
       {m[0][2] - m[2][0], m[0][1] + m[1][0], 1 - m[0][0] + m[1][1] - m[2][2], m[1][2] + m[2][1]},
       {m[1][0] - m[0][1], m[0][2] + m[2][0], m[1][2] + m[2][1], 1 - m[0][0] - m[1][1] + m[2][2]}};
   int largest = 0;
   for (int k = 1; k < 4; ++k)
      if (outer[k][k] > outer[largest][largest] + kLatticeTolerance)
         largest = k;
   double q[4];
   double sign = 0;
   for (int k = 0; k < 4; ++k) {
      q[k] = outer[largest][k] / std::sqrt(4 * outer[largest][largest]);
      const double quarters = std::round(4 * q[k] * q[k]);
      if (std::abs(4 * q[k] * q[k] - quarters) < kLatticeTolerance)
         q[k] = std::copysign(std::sqrt(quarters / 4), quarters == 0 ? 1 : q[k]);
      if (sign == 0 && q[k] != 0)
         sign = q[k] > 0 ? 1 : -1;
   }
   const auto signedOf = [&](int k) { return q[k] == 0 ? 0 : sign * q[k]; };
   return {signedOf(0), signedOf(1), signedOf(2), signedOf(3)};
}

/// Order of rotations: turns about z by rising angle (the identity first), then by rising angle and, for one
/// angle, by axis with larger x, y, z first.
inline auto rank(const Turn &t)
{
   const auto fixed = [](double value) { return std::llround(value * 1e6); };
   const bool aboutZ = fixed(t.x) == 0 && fixed(t.y) == 0;
   const double zTurn = 2 * std::atan2(t.z, t.w);
   const double angle = aboutZ ? (zTurn < -kLatticeTolerance ? zTurn + 2 * std::acos(-1.0) : zTurn)
                               : 2 * std::acos(std::min(1.0, t.w));
   return std::make_tuple(!aboutZ, fixed(angle), -fixed(t.x), -fixed(t.y), -fixed(t.z));
}

} // namespace detail

/// Every rotation that maps the shape onto itself, in the order of detail::rank().
inline std::vector<Turn> rotations(const Shape &shape)
{
   const auto &p = shape.vertices;
   const auto isCorner = [&](Vec v) {
      return std::any_of(p.begin(), p.end(), [&](Vec corner) { return same(corner, v); });
   };
   const Vec first = p.at(0);
   const auto other =
       std::find_if(p.begin(), p.end(), [&](Vec v) { return length(cross(first, v)) > kLatticeTolerance; });
   if (other == p.end())
      throw Failure(DIATOM_BAD_INPUT, "the shape has no extent about the origin");
   std::vector<Turn> turns;
   for (const Vec a : p)
      for (const Vec b : p) {
         const auto differ = [](double one, double two) { return std::abs(one - two) > kLatticeTolerance; };
         if (differ(length(a), length(first)) || differ(length(b), length(*other)) ||
             differ(dot(a, b), dot(first, *other)))
            continue;
         const Turn t = detail::between(detail::axes(first, *other), detail::axes(a, b));
         if (std::all_of(p.begin(), p.end(), [&](Vec corner) { return isCorner(t(corner)); }))
            turns.push_back(t);
      }
   std::sort(turns.begin(), turns.end(),
             [](const Turn &a, const Turn &b) { return detail::rank(a) < detail::rank(b); });
   return turns;
}

} // namespace v1
} // namespace diatom::sdk

#include <diatom/lattice_motif.hpp>

/// Makes the file a plugin that provides the lattice `function(const Values &)` returns.
#define DIATOM_LATTICE(function)                                                                             \
   static const void *diatomLatticeTable(const char *interface)                                              \
   {                                                                                                         \
      static constexpr diatom_lattice table = ::diatom::sdk::LatticeModule<&(function)>::table();            \
      return std::string_view(interface) == DIATOM_LATTICE_1 ? &table : nullptr;                             \
   }                                                                                                         \
   DIATOM_MODULE(diatomLatticeTable)
