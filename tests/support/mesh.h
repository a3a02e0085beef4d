// What tests ask of triangle meshes: closed, which volume, which bounds. Corners are one point only when
// their numbers are exactly equal.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace diatom::test {

template<typename Number>
using Corner = std::array<Number, 3>;
template<typename Number>
using Triangle = std::array<Corner<Number>, 3>;

struct MeshFacts
{
   bool closed = false;   // every edge is used as often in one direction as in the other
   bool manifold = false; // and exactly once in each
   double volume = 0;     // signed; positive when the triangles look outward
   std::array<double, 3> least{}, most{};
};

template<typename Number>
MeshFacts meshFacts(const std::vector<Triangle<Number>> &triangles)
{
   MeshFacts facts;
   std::map<Corner<Number>, int> numbers;
   std::map<std::pair<int, int>, int> edges;
   facts.least.fill(1e300);
   facts.most.fill(-1e300);
   for (const auto &triangle : triangles) {
      int corner[3];
      for (std::size_t k = 0; k < 3; ++k) {
         corner[k] = numbers.emplace(triangle[k], static_cast<int>(numbers.size())).first->second;
         for (std::size_t axis = 0; axis < 3; ++axis) {
            facts.least[axis] = std::min(facts.least[axis], static_cast<double>(triangle[k][axis]));
            facts.most[axis] = std::max(facts.most[axis], static_cast<double>(triangle[k][axis]));
         }
      }
      for (int k = 0; k < 3; ++k)
         ++edges[{corner[k], corner[(k + 1) % 3]}];
      double v[3][3];
      for (std::size_t k = 0; k < 3; ++k) // about the first corner, against cancellation far from the origin
         for (std::size_t axis = 0; axis < 3; ++axis)
            v[k][axis] = static_cast<double>(triangle[k][axis]) - static_cast<double>(triangles[0][0][axis]);
      facts.volume += (v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
                       v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                       v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0])) /
                      6;
   }
   facts.closed = facts.manifold = !triangles.empty();
   for (const auto &[edge, uses] : edges) {
      const auto reverse = edges.find({edge.second, edge.first});
      const int back = reverse == edges.end() ? 0 : reverse->second;
      facts.closed = facts.closed && back == uses && edge.first != edge.second;
      facts.manifold = facts.manifold && back == 1 && uses == 1 && edge.first != edge.second;
   }
   return facts;
}

/// What is wrong with a surface as a 2-manifold, told by its indices alone; empty when nothing is.
inline std::string manifoldFault(const std::vector<std::array<std::uint32_t, 3>> &triangles,
                                 std::size_t vertices)
{
   std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> thirds; // directed edge, opposite corner
   std::vector<std::uint32_t> uses(vertices, 0);
   for (const auto &t : triangles)
      for (std::size_t k = 0; k < 3; ++k) {
         if (t[k] >= vertices)
            return "an index beyond the vertices";
         ++uses[t[k]];
         if (!thirds.emplace(std::pair(t[k], t[(k + 1) % 3]), t[(k + 2) % 3]).second)
            return "an edge used twice in one direction";
      }
   for (const auto &[edge, third] : thirds)
      if (!thirds.count({edge.second, edge.first}))
         return "an edge with one triangle";
   std::vector<bool> seen(vertices, false);
   for (const auto &[edge, third] : thirds) { // round each vertex once, from one of its triangles to the next
      const auto [centre, start] = edge;
      if (seen[centre])
         continue;
      seen[centre] = true;
      std::uint32_t round = 0, spoke = start;
      do {
         spoke = thirds.at({centre, spoke});
         ++round;
      } while (spoke != start && round <= uses[centre]);
      if (round != uses[centre])
         return "a vertex with more than one fan";
   }
   if (std::find(uses.begin(), uses.end(), 0u) != uses.end())
      return "a vertex without a triangle";
   return triangles.empty() ? "no triangles" : "";
}

} // namespace diatom::test
