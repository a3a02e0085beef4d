#include "io/split_contacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

namespace diatom {

namespace {

constexpr std::uint32_t kNone = 0xffff'ffff;

/// A directed edge: corner 3 t + k of triangle t, towards its next corner. Sorted, the uses of one edge stand
/// side by side in the order of the triangles.
struct Use
{
   std::uint32_t low, high, corner;
   bool forward; // from low to high
   bool sameEdge(const Use &other) const { return low == other.low && high == other.high; }
   auto operator<=>(const Use &) const = default;
};

class Splitter
{
public:
   explicit Splitter(SolidMesh &mesh) : m_mesh(mesh) {}

   Status run()
   {
      sortUses();
      m_parent.resize(3 * m_mesh.triangles.size());
      std::iota(m_parent.begin(), m_parent.end(), 0u);
      m_contactEnd.assign(m_mesh.vertices.size(), false);
      for (auto first = m_uses.begin(); first != m_uses.end();) {
         auto last = first + 1;
         while (last != m_uses.end() && last->sameEdge(*first))
            ++last;
         if (Status paired = pairUp({first, last}); !paired)
            return paired;
         first = last;
      }
      renumber();
      separateEdges();
      return {};
   }

private:
   using Pair = std::array<std::uint32_t, 2>; // corners where the two directed uses begin

   void sortUses()
   {
      m_uses.reserve(3 * m_mesh.triangles.size());
      for (std::uint32_t t = 0; t < m_mesh.triangles.size(); ++t)
         for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t a = m_mesh.triangles[t][k], b = m_mesh.triangles[t][(k + 1) % 3];
            m_uses.push_back({std::min(a, b), std::max(a, b), 3 * t + k, a < b});
         }
      std::sort(m_uses.begin(), m_uses.end());
   }

   static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
   std::uint32_t vertexAt(std::uint32_t corner) const { return m_mesh.triangles[corner / 3][corner % 3]; }

   std::uint32_t root(std::uint32_t corner)
   {
      while (m_parent[corner] != corner)
         corner = m_parent[corner] = m_parent[m_parent[corner]];
      return corner;
   }

   void join(std::uint32_t a, std::uint32_t b)
   {
      a = root(a);
      b = root(b);
      m_parent[std::max(a, b)] = std::min(a, b); // the first corner speaks for all
   }

   void joinPair(const Pair &pair)
   {
      join(pair[0], next(pair[1]));
      join(next(pair[0]), pair[1]);
   }

   Status pairUp(std::span<const Use> uses)
   {
      const auto forward = static_cast<std::size_t>(
          std::count_if(uses.begin(), uses.end(), [](const Use &u) { return u.forward; }));
      const Use &edge = uses.front();
      if (2 * forward != uses.size() || edge.low == edge.high) {
         const Vec3 &at = m_mesh.vertices[edge.low];
         return Error{ErrorCode::invalid,
                      fmt::format("the surface is not closed at ({:.9g}, {:.9g}, {:.9g}) m; "
                                  "check the lattice or parts plugin that made it",
                                  at.x(), at.y(), at.z())};
      }
      if (forward == 1) {
         joinPair({uses[0].corner, uses[1].corner});
         return {};
      }
      ++m_mesh.edgeContacts;
      m_contactEnd[edge.low] = m_contactEnd[edge.high] = true;
      for (const Pair &pair : wedges(uses)) {
         joinPair(pair);
         m_contactPairs.push_back(pair);
      }
      m_contactRuns.push_back(m_contactPairs.size());
      return {};
   }

   /// Pairs the uses of a crowded edge so that each pair bounds one wedge of solid. Looking along the edge
   /// from low to high and turning counter-clockwise, a use against that direction enters solid and one along
   /// it leaves solid.
   std::vector<Pair> wedges(std::span<const Use> uses) const
   {
      const Vec3 &low = m_mesh.vertices[uses.front().low];
      const Vec3 along = (m_mesh.vertices[uses.front().high] - low).normalized();
      const auto spoke = [&](const Use &use) -> Vec3 {
         const Vec3 to = m_mesh.vertices[vertexAt(next(next(use.corner)))] - low;
         return to - along * along.dot(to);
      };
      const auto entering = std::find_if(uses.begin(), uses.end(), [](const Use &u) { return !u.forward; });
      const Vec3 zero = spoke(*entering).normalized(), quarter = along.cross(zero);
      struct Step
      {
         long long angle; // in 1e-9 rad, so that rounding does not part faces that lie on each other
         bool enters;     // leaving comes first where solids meet in a plane
         std::uint32_t corner;
         auto operator<=>(const Step &) const = default;
      };
      std::vector<Step> steps;
      const long long turn = std::llround(2 * std::numbers::pi * 1e9);
      for (const Use &use : uses) {
         const Vec3 to = spoke(use);
         long long angle = std::llround(std::atan2(quarter.dot(to), zero.dot(to)) * 1e9);
         if (angle < -2)
            angle += turn;
         if (use.forward && angle <= 2)
            angle = turn;
         if (!use.forward && (angle >= turn - 2 || angle < 0))
            angle = 0;
         steps.push_back({angle, !use.forward, use.corner});
      }
      std::sort(steps.begin(), steps.end());
      std::vector<Pair> pairs;
      std::vector<std::uint32_t> open, unmatched;
      for (const Step &step : steps) {
         if (step.enters)
            open.push_back(step.corner);
         else if (open.empty())
            unmatched.push_back(step.corner);
         else {
            pairs.push_back({open.back(), step.corner});
            open.pop_back();
         }
      }
      for (std::size_t i = 0; i < unmatched.size(); ++i) // only where solids overlap
         pairs.push_back({open[i], unmatched[i]});
      return pairs;
   }

   void renumber()
   {
      std::vector<Vec3> vertices;
      vertices.reserve(m_mesh.vertices.size());
      std::vector<std::uint32_t> number(m_parent.size(), kNone), fans(m_mesh.vertices.size(), 0);
      for (std::uint32_t corner = 0; corner < m_parent.size(); ++corner) {
         const std::uint32_t speaker = root(corner), old = vertexAt(corner);
         if (number[speaker] == kNone) {
            number[speaker] = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(m_mesh.vertices[old]);
            if (++fans[old] == 2 && !m_contactEnd[old])
               ++m_mesh.vertexContacts;
         }
         m_mesh.triangles[corner / 3][corner % 3] = number[speaker];
      }
      m_mesh.vertices = std::move(vertices);
   }

   /// Pairs round one edge whose two ends are still the same vertices would be one edge with four triangles.
   void separateEdges()
   {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> midpoints; // corner, vertex
      std::size_t first = 0;
      for (const std::size_t last : m_contactRuns) {
         for (std::size_t i = first; i < last; ++i) {
            bool crowded = false;
            for (std::size_t j = first; j < i; ++j)
               crowded = crowded || ends(m_contactPairs[i]) == ends(m_contactPairs[j]);
            if (!crowded)
               continue;
            const auto [low, high] = ends(m_contactPairs[i]);
            for (const std::uint32_t corner : m_contactPairs[i])
               midpoints.emplace_back(corner, static_cast<std::uint32_t>(m_mesh.vertices.size()));
            m_mesh.vertices.push_back((m_mesh.vertices[low] + m_mesh.vertices[high]) / 2);
         }
         first = last;
      }
      std::sort(midpoints.begin(), midpoints.end());
      for (std::size_t i = 0; i < midpoints.size();) {
         std::array<std::uint32_t, 3> middle{kNone, kNone, kNone};
         const std::uint32_t t = midpoints[i].first / 3;
         for (; i < midpoints.size() && midpoints[i].first / 3 == t; ++i)
            middle[midpoints[i].first % 3] = midpoints[i].second;
         cut(t, middle);
      }
   }

   std::pair<std::uint32_t, std::uint32_t> ends(const Pair &pair) const
   {
      return std::minmax(vertexAt(pair[0]), vertexAt(next(pair[0])));
   }

   /// Replaces a triangle by those that use the midpoints of its edges.
   void cut(std::uint32_t t, const std::array<std::uint32_t, 3> &middle)
   {
      std::vector<std::uint32_t> ring; // begins at a midpoint, from which all others can be reached
      const auto has = static_cast<std::uint32_t>(
          std::find_if(middle.begin(), middle.end(), [](auto m) { return m != kNone; }) - middle.begin());
      const auto corners = m_mesh.triangles[t];
      for (std::uint32_t k = 0; k < 3; ++k) {
         const std::uint32_t edge = (has + k) % 3;
         if (middle[edge] != kNone)
            ring.push_back(middle[edge]);
         ring.push_back(corners[(edge + 1) % 3]);
      }
      const MaterialIndex material = m_mesh.materials[t];
      std::vector<std::array<std::uint32_t, 3>> pieces;
      for (std::size_t i = 2; i < ring.size(); ++i)
         pieces.push_back({ring[0], ring[i - 1], ring[i]});
      m_mesh.triangles[t] = pieces[0];
      for (std::size_t i = 1; i < pieces.size(); ++i) {
         m_mesh.triangles.push_back(pieces[i]);
         m_mesh.materials.push_back(material);
      }
   }

   SolidMesh &m_mesh;
   std::vector<Use> m_uses;
   std::vector<std::uint32_t> m_parent; // of corners: those that are one vertex
   std::vector<bool> m_contactEnd;
   std::vector<Pair> m_contactPairs;
   std::vector<std::size_t> m_contactRuns; // where the pairs of each edge end
};

} // namespace

Status splitContacts(SolidMesh &mesh) { return Splitter(mesh).run(); }

} // namespace diatom
