#include "io/mesh_faults.h"

#include "io/point_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace diatom {

namespace {

/// Number of the place of each vertex: the same for equal coordinates.
std::vector<std::int32_t> placesOf(const std::vector<Vec3> &vertices)
{
   PointNumbers numbers;
   std::vector<Vec3> points;
   std::vector<std::int32_t> places;
   places.reserve(vertices.size());
   for (const Vec3 &vertex : vertices)
      places.push_back(static_cast<std::int32_t>(numbers.number(vertex, points)));
   return places;
}

/// One side of a triangle.
struct Side
{
   std::int32_t low, high; // places it joins
   bool forward;           // from low to high
   std::int32_t triangle;
   auto operator<=>(const Side &) const = default;
};

/// All sides, those of one edge beside each other. Sides without length are left out.
std::vector<Side> sidesOf(const TriangleMesh &mesh)
{
   const auto place = placesOf(mesh.vertices);
   std::vector<Side> sides;
   sides.reserve(3 * mesh.triangles.size());
   for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
         const std::int32_t a = place[static_cast<std::size_t>(mesh.triangles[t][k])],
                            b = place[static_cast<std::size_t>(mesh.triangles[t][(k + 1) % 3])];
         if (a != b)
            sides.push_back({std::min(a, b), std::max(a, b), a < b, static_cast<std::int32_t>(t)});
      }
   std::sort(sides.begin(), sides.end());
   return sides;
}

/// Calls visit(sides) for each edge.
template<typename Visit>
void forEdges(const std::vector<Side> &sides, const Visit &visit)
{
   for (std::size_t from = 0; from < sides.size();) {
      std::size_t to = from;
      while (to < sides.size() && sides[to].low == sides[from].low && sides[to].high == sides[from].high)
         ++to;
      visit(std::span(sides).subspan(from, to - from));
      from = to;
   }
}

/// Six times the volume between the triangle and the point.
double volumeOf(const TriangleMesh &mesh, std::size_t triangle, const Vec3 &from)
{
   const auto at = [&](std::size_t k) {
      return Vec3(mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][k])] - from);
   };
   return at(0).dot(at(1).cross(at(2)));
}

} // namespace

MeshFaults findFaults(const TriangleMesh &mesh)
{
   MeshFaults faults;
   for (const auto &triangle : mesh.triangles) {
      const auto at = [&](std::size_t k) -> const Vec3 & {
         return mesh.vertices[static_cast<std::size_t>(triangle[k])];
      };
      faults.flat += (at(1) - at(0)).cross(at(2) - at(0)).isZero(0) ? 1 : 0;
   }
   forEdges(sidesOf(mesh), [&](std::span<const Side> edge) {
      const auto forward =
          std::count_if(edge.begin(), edge.end(), [](const Side &side) { return side.forward; });
      const bool cancel = 2 * forward == std::ssize(edge);
      if (!cancel)
         ++(edge.size() == 1 ? faults.open : edge.size() == 2 ? faults.opposed : faults.uneven);
   });
   return faults;
}

std::uint64_t orientTriangles(TriangleMesh &mesh)
{
   struct Neighbour
   {
      std::int32_t triangle;
      bool agrees;
   };
   std::vector<std::vector<Neighbour>> neighbours(mesh.triangles.size());
   forEdges(sidesOf(mesh), [&](std::span<const Side> edge) {
      if (edge.size() != 2)
         return;
      const bool agrees = edge[0].forward != edge[1].forward;
      neighbours[static_cast<std::size_t>(edge[0].triangle)].push_back({edge[1].triangle, agrees});
      neighbours[static_cast<std::size_t>(edge[1].triangle)].push_back({edge[0].triangle, agrees});
   });
   const Vec3 middle = mesh.bounds().center();
   std::vector<std::int8_t> way(mesh.triangles.size(), 0); // 1 as it is, -1 turned, 0 not seen
   std::uint64_t turned = 0;
   double whole = 0;
   const auto turn = [&](std::size_t triangle) {
      std::swap(mesh.triangles[triangle][1], mesh.triangles[triangle][2]);
      ++turned;
   };
   for (std::size_t start = 0; start < mesh.triangles.size(); ++start) {
      if (way[start] != 0)
         continue;
      std::vector<std::size_t> part{start};
      way[start] = 1;
      bool agree = true;
      double volume = 0;
      for (std::size_t k = 0; k < part.size(); ++k) {
         const std::size_t at = part[k];
         volume += way[at] * volumeOf(mesh, at, middle);
         for (const Neighbour &next : neighbours[at]) {
            auto &other = way[static_cast<std::size_t>(next.triangle)];
            agree = agree && next.agrees;
            if (other == 0) {
               other = static_cast<std::int8_t>(next.agrees ? way[at] : -way[at]);
               part.push_back(static_cast<std::size_t>(next.triangle));
            }
         }
      }
      if (!agree)
         for (const std::size_t triangle : part)
            if ((way[triangle] > 0) == (volume < 0))
               turn(triangle);
      whole += agree ? volume : std::abs(volume);
   }
   if (whole < 0) {
      for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle)
         turn(triangle);
      turned = mesh.triangles.size();
   }
   return turned;
}

std::string MeshFaults::text() const
{
   std::string list;
   const auto add = [&](std::uint64_t count, const char *what) {
      if (count > 0)
         list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, what);
   };
   add(open, "open edges");
   add(opposed, "edges between triangles that look to different sides");
   add(uneven, "edges of more than two triangles");
   return list.empty() ? list
                       : "the mesh is not closed (" + list +
                             "): cells count as inside where the surface winds more than half around them";
}

} // namespace diatom
