#include "io/node_hull.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace diatom {

namespace {

constexpr double kMargin = 1.02;   // so that end polygons do not touch
constexpr double kLeast = 0.5;     // radii; straight joints and free ends have no crotch
constexpr double kCoplanar = 1e-7; // of the joint's size

/// Gift wrapping from known faces over their edges.
class Wrapping
{
public:
   explicit Wrapping(std::span<const Vec3> points) : m_points(points)
   {
      for (const Vec3 &point : points)
         m_centre += point / static_cast<double>(points.size());
      for (const Vec3 &point : points)
         m_size = std::max(m_size, (point - m_centre).norm());
   }

   /// False when an edge would have two faces on one side.
   bool add(const std::vector<int> &face)
   {
      for (std::size_t k = 0; k < face.size(); ++k) {
         const std::pair edge(face[k], face[(k + 1) % face.size()]);
         if (!m_covered.emplace(edge, true).second)
            return false;
         m_waiting.emplace_back(edge.second, edge.first);
      }
      return true;
   }

   bool covered(const std::pair<int, int> &edge) const { return m_covered.count(edge) != 0; }

   std::optional<std::pair<int, int>> next()
   {
      while (m_first < m_waiting.size()) {
         const auto edge = m_waiting[m_first++];
         if (!covered(edge))
            return edge;
      }
      return {};
   }

   /// The face to the left of the edge: all points in the plane that has every other point behind it.
   std::vector<int> faceAt(const std::pair<int, int> &edge) const
   {
      const Vec3 &a = m_points[static_cast<std::size_t>(edge.first)],
                 &b = m_points[static_cast<std::size_t>(edge.second)];
      const Vec3 along = (b - a).normalized();
      Vec3 normal = Vec3::Zero();
      const double tolerance = kCoplanar * m_size;
      for (int c = 0; c < static_cast<int>(m_points.size()); ++c) {
         const Vec3 to = m_points[static_cast<std::size_t>(c)] - a;
         const Vec3 turned = along.cross(to);
         if (c == edge.first || c == edge.second || turned.norm() < tolerance)
            continue;
         if (normal.isZero() || normal.dot(to) > tolerance)
            normal = turned.normalized();
      }
      std::vector<std::pair<double, int>> ring;
      Vec3 middle = Vec3::Zero();
      for (int c = 0; c < static_cast<int>(m_points.size()); ++c)
         if (std::abs(normal.dot(m_points[static_cast<std::size_t>(c)] - a)) <= tolerance) {
            ring.emplace_back(0, c);
            middle += m_points[static_cast<std::size_t>(c)];
         }
      middle /= static_cast<double>(ring.size());
      const Vec3 zero = (a - middle).normalized(), quarter = normal.cross(zero);
      for (auto &[angle, c] : ring) {
         const Vec3 to = m_points[static_cast<std::size_t>(c)] - middle;
         angle = c == edge.first ? -4 : std::atan2(quarter.dot(to), zero.dot(to));
         if (c != edge.first && angle < 0)
            angle += 2 * std::numbers::pi;
      }
      std::sort(ring.begin(), ring.end());
      std::vector<int> face;
      for (const auto &[angle, c] : ring)
         face.push_back(c);
      return face;
   }

private:
   std::span<const Vec3> m_points;
   Vec3 m_centre = Vec3::Zero();
   double m_size = 0;
   std::map<std::pair<int, int>, bool> m_covered;
   std::vector<std::pair<int, int>> m_waiting;
   std::size_t m_first = 0;
};

} // namespace

double setBack(std::span<const Vec3> leaving)
{
   double radii = kLeast;
   for (std::size_t i = 0; i < leaving.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
         // cot(t/2), by that of its two forms which is good at this angle; 1e9 for struts on each other.
         const double sine = leaving[i].cross(leaving[j]).norm(), cosine = leaving[i].dot(leaving[j]);
         const double crotch = cosine > 0 ? (1 + cosine) / std::max(sine, 2e-9) : sine / (1 - cosine);
         radii = std::max(radii, kMargin * crotch);
      }
   return radii;
}

std::optional<std::vector<std::vector<int>>> joiningFaces(std::span<const Vec3> points, int ends, int sides)
{
   Wrapping wrapping(points);
   for (int end = 0; end < ends; ++end) {
      std::vector<int> face;
      for (int k = 0; k < sides; ++k)
         face.push_back(end * sides + k);
      if (!wrapping.add(face))
         return {};
   }
   std::vector<std::vector<int>> faces;
   const std::size_t most = 4 * points.size(); // Euler: a hull of n points has fewer than 2 n faces
   while (const auto edge = wrapping.next()) {
      auto face = wrapping.faceAt(*edge);
      if (face.size() < 3 || face[1] != edge->second || faces.size() > most || !wrapping.add(face))
         return {};
      faces.push_back(std::move(face));
   }
   return faces;
}

} // namespace diatom
