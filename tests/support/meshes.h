// Meshes made by rule, for tests of what is read and filled.
#pragma once

#include "io/triangle_mesh.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace diatom::test {

/// A box of 12 triangles that look outward, added to the mesh as a piece of its own.
inline void addBox(TriangleMesh &mesh, const Vec3 &low, const Vec3 &high, const std::string &name = {})
{
   const auto first = static_cast<std::int32_t>(mesh.vertices.size());
   for (int corner = 0; corner < 8; ++corner)
      mesh.vertices.emplace_back(corner & 4 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
                                 corner & 1 ? high.z() : low.z());
   static constexpr int faces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                       {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
   for (const auto &f : faces)
      for (const auto &corners : {std::array{f[0], f[1], f[2]}, std::array{f[0], f[2], f[3]}}) {
         mesh.triangles.push_back({first + corners[0], first + corners[1], first + corners[2]});
         mesh.piece.push_back(static_cast<std::int32_t>(mesh.pieces.size()));
      }
   mesh.pieces.push_back({name, {}, false});
}

inline TriangleMesh boxMesh(const Vec3 &low, const Vec3 &high)
{
   TriangleMesh mesh;
   addBox(mesh, low, high);
   return mesh;
}

/// An octahedron split `times` in four and blown up to the sphere: 8 * 4^times triangles.
inline TriangleMesh sphereMesh(const Vec3 &center, double radius, int times)
{
   TriangleMesh mesh;
   mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
   mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
   for (int round = 0; round < times; ++round) {
      std::map<std::pair<int, int>, int> middles;
      const auto middle = [&](int a, int b) {
         const auto [at, added] =
             middles.try_emplace({std::min(a, b), std::max(a, b)}, std::ssize(mesh.vertices));
         if (added)
            mesh.vertices.push_back(
                (mesh.vertices[std::size_t(a)] + mesh.vertices[std::size_t(b)]).normalized());
         return at->second;
      };
      const auto before = std::exchange(mesh.triangles, {});
      for (const auto &[a, b, c] : before) {
         const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
         for (const auto &part :
              {std::array{a, ab, ca}, std::array{ab, b, bc}, std::array{ca, bc, c}, std::array{ab, bc, ca}})
            mesh.triangles.push_back({part[0], part[1], part[2]});
      }
   }
   for (Vec3 &vertex : mesh.vertices)
      vertex = center + radius * vertex;
   mesh.piece.assign(mesh.triangles.size(), 0);
   mesh.pieces.resize(1);
   return mesh;
}

/// Volume that the triangles enclose; negative when they look inward.
inline double volumeOf(const TriangleMesh &mesh)
{
   double six = 0;
   for (const auto &[a, b, c] : mesh.triangles)
      six += mesh.vertices[std::size_t(a)].dot(
          mesh.vertices[std::size_t(b)].cross(mesh.vertices[std::size_t(c)]));
   return six / 6;
}

} // namespace diatom::test
