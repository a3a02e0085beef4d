#include "lattice/shape_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace diatom {

namespace {

constexpr int kMaxVertices = 512, kMaxFaces = 512, kMaxRotations = 120;
constexpr double kMaxNumber = 1e6;  // lattice units
constexpr double kTolerance = 1e-6; // relative to the size of a cell
constexpr double kUnitLength = 1e-9;

using Fault = std::optional<std::string>;

/// Each check may rely on those before it.
class ShapeGuard
{
public:
   ShapeGuard(const diatom_motif &motif, int number) : m_motif(motif), m_number(number) {}

   Fault first()
   {
      if (Fault fault = counts())
         return fault;
      for (int v = m_motif.shape_vertex_start[m_number]; v < m_motif.shape_vertex_start[m_number + 1]; ++v) {
         if (!allFinite(m_motif.vertices + 3 * v, 3))
            return fmt::format("a corner of shape {} is not finite or is beyond 1e6", m_number);
         m_shape.vertices.emplace_back(m_motif.vertices + 3 * v);
      }
      if (Fault fault = faces())
         return fault;
      if (Fault fault = closed())
         return fault;
      if (Fault fault = convex())
         return fault;
      return rotations();
   }
   CheckedShape take() { return std::move(m_checked); }

private:
   Fault counts() const;
   Fault faces();
   Fault closed() const;
   Fault convex();
   Fault rotations();

   const diatom_motif &m_motif;
   int m_number;
   CheckedShape m_checked;
   Shape &m_shape = m_checked.shape;
};

Fault ShapeGuard::counts() const
{
   const auto &m = m_motif;
   if (!rises(m.shape_vertex_start + m_number, 1, kMaxVertices) ||
       !rises(m.shape_face_start + m_number, 1, kMaxFaces) ||
       !rises(m.rotation_start + m_number, 1, kMaxRotations) ||
       !rises(m.face_start + m.shape_face_start[m_number],
              m.shape_face_start[m_number + 1] - m.shape_face_start[m_number], kMaxVertices))
      return fmt::format("the counts of shape {} fall, or are too large", m_number);
   if (m.shape_vertex_start[m_number + 1] - m.shape_vertex_start[m_number] < 4 ||
       m.shape_face_start[m_number + 1] - m.shape_face_start[m_number] < 4)
      return fmt::format("shape {} has fewer than 4 corners or faces", m_number);
   return std::nullopt;
}

Fault ShapeGuard::faces()
{
   const auto &m = m_motif;
   const int corners = m.shape_vertex_start[m_number + 1] - m.shape_vertex_start[m_number];
   for (int f = m.shape_face_start[m_number]; f < m.shape_face_start[m_number + 1]; ++f) {
      std::vector<int> face(m.face_vertices + m.face_start[f], m.face_vertices + m.face_start[f + 1]);
      const int nth = f - m.shape_face_start[m_number];
      if (face.size() < 3 || std::set<int>(face.begin(), face.end()).size() != face.size())
         return fmt::format("face {} of shape {} has fewer than 3 corners, or one twice", nth, m_number);
      if (std::any_of(face.begin(), face.end(), [&](int v) { return v < 0 || v >= corners; }))
         return fmt::format("face {} of shape {} has a corner that is not there", nth, m_number);
      m_shape.faces.push_back(std::move(face));
   }
   m_shape.edges = edgesOf(m_shape.faces);
   return std::nullopt;
}

// Every edge once in each direction, every corner used, and Euler's count for a ball.
Fault ShapeGuard::closed() const
{
   std::set<std::pair<int, int>> directed;
   std::set<int> used;
   for (const auto &face : m_shape.faces)
      for (std::size_t k = 0; k < face.size(); ++k) {
         used.insert(face[k]);
         if (!directed.emplace(face[k], face[(k + 1) % face.size()]).second)
            return fmt::format("shape {} is not a closed surface: an edge is walked twice in one direction",
                               m_number);
      }
   for (const auto &[a, b] : directed)
      if (!directed.contains({b, a}))
         return fmt::format(
             "shape {} is not closed: the edge from corner {} to {} has a face on one side only", m_number, a,
             b);
   if (used.size() != m_shape.vertices.size() ||
       m_shape.vertices.size() + m_shape.faces.size() != m_shape.edges.size() + 2)
      return fmt::format("shape {} is not one closed surface that uses every corner", m_number);
   return std::nullopt;
}

Fault ShapeGuard::convex()
{
   double outer = 0;
   for (const Vec3 &v : m_shape.vertices)
      outer = std::max(outer, v.norm());
   const double tolerance = kTolerance * outer;
   double inner = outer, sixfold = 0; // six times the volume, by the divergence theorem
   for (std::size_t f = 0; f < m_shape.faces.size(); ++f) {
      const auto &face = m_shape.faces[f];
      const auto corner = [&](std::size_t k) {
         return m_shape.vertices[static_cast<std::size_t>(face[k % face.size()])];
      };
      Vec3 normal = Vec3::Zero(); // twice the area, by Newell
      for (std::size_t k = 0; k < face.size(); ++k)
         normal += corner(k).cross(corner(k + 1));
      sixfold += normal.dot(corner(0));
      normal.normalize();
      for (const Vec3 &v : m_shape.vertices)
         if (!(normal.dot(v - corner(0)) <= tolerance))
            return fmt::format("shape {} is not convex at face {}, or the face is walked clockwise", m_number,
                               f);
      for (std::size_t k = 0; k < face.size(); ++k) {
         if (!(std::abs(normal.dot(corner(k) - corner(0))) <= tolerance))
            return fmt::format("face {} of shape {} is not flat", f, m_number);
         if (!((corner(k + 1) - corner(k)).cross(corner(k + 2) - corner(k + 1)).dot(normal) >
               tolerance * tolerance))
            return fmt::format("face {} of shape {} is not a convex polygon", f, m_number);
      }
      inner = std::min(inner, normal.dot(corner(0)));
   }
   m_shape.volume = sixfold / 6;
   if (!(inner > tolerance && m_shape.volume > 0))
      return fmt::format("shape {} has no volume about its centre", m_number);
   m_checked.inner = inner;
   m_checked.outer = outer;
   return std::nullopt;
}

Fault ShapeGuard::rotations()
{
   const double tolerance = kTolerance * m_checked.outer;
   for (int r = m_motif.rotation_start[m_number]; r < m_motif.rotation_start[m_number + 1]; ++r) {
      const double *q = m_motif.rotations + 4 * r;
      const int nth = r - m_motif.rotation_start[m_number];
      if (!unit(q))
         return fmt::format("rotation {} of shape {} is not a unit quaternion", nth, m_number);
      const Quat rotation = Quat(q[0], q[1], q[2], q[3]).normalized();
      if (nth == 0 && std::abs(std::abs(q[0]) - 1) > kUnitLength)
         return fmt::format("the first rotation of shape {} is not the identity", m_number);
      for (const Quat &other : m_shape.rotations)
         if (std::abs(other.dot(rotation)) > 1 - kTolerance)
            return fmt::format("rotation {} of shape {} is there twice", nth, m_number);
      for (const Vec3 &v : m_shape.vertices)
         if (std::none_of(m_shape.vertices.begin(), m_shape.vertices.end(),
                          [&](const Vec3 &w) { return (rotation * v - w).norm() < tolerance; }))
            return fmt::format("rotation {} of shape {} does not map the shape onto itself", nth, m_number);
      m_shape.rotations.push_back(rotation);
   }
   if (m_shape.rotations.empty())
      return fmt::format("shape {} has no rotation, not even the identity", m_number);
   return std::nullopt;
}

} // namespace

bool allFinite(const double *values, int count)
{
   return std::all_of(values, values + count, [](double v) { return std::abs(v) <= kMaxNumber; });
}

bool rises(const std::int32_t *start, int count, int largest)
{
   for (int n = 0; n < count; ++n)
      if (start[n + 1] < start[n] || start[n + 1] - start[n] > largest)
         return false;
   return true;
}

bool unit(const double *q)
{
   return allFinite(q, 4) && std::abs(Eigen::Map<const Eigen::Vector4d>(q).norm() - 1) < kUnitLength;
}

std::vector<std::array<int, 2>> edgesOf(const std::vector<std::vector<int>> &faces)
{
   std::vector<std::array<int, 2>> edges;
   std::set<std::array<int, 2>> known;
   for (const auto &face : faces)
      for (std::size_t k = 0; k < face.size(); ++k) {
         const int a = face[k], b = face[(k + 1) % face.size()];
         const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
         if (known.insert(edge).second)
            edges.push_back(edge);
      }
   return edges;
}

Result<CheckedShape> checkShape(const diatom_motif &motif, int number)
{
   ShapeGuard guard(motif, number);
   if (const auto fault = guard.first())
      return Error{ErrorCode::unsupported, *fault};
   return guard.take();
}

} // namespace diatom
