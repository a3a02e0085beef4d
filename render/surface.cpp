#include "render/surface.h"

#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

namespace diatom::render {

namespace {

/// 108 bytes each.
constexpr std::uint64_t kMostTriangles = 2'000'000;
/// Flats of a round strut with 8 sides meet at 45 degrees and look smooth; the edges of bricks do not.
const double kSmooth = std::cos(50 * std::numbers::pi / 180);

struct Side
{
   std::uint32_t low, high, triangle;
   std::uint8_t number; // opposite to which corner
};

Vec3 normalOf(const SolidMesh &mesh, std::size_t triangle)
{
   const auto &[a, b, c] = mesh.triangles[triangle];
   const Vec3 across = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
   const double size = across.norm();
   return size > 0 ? Vec3(across / size) : Vec3::Zero();
}

/// By triangle and edge: whether its two sides make a sharp angle or are of two materials.
std::vector<std::array<bool, 3>> sharpEdges(const SolidMesh &mesh, const std::vector<Vec3> &normals)
{
   std::vector<Side> sides;
   sides.reserve(3 * mesh.triangles.size());
   for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::uint8_t k = 0; k < 3; ++k) {
         const std::uint32_t a = mesh.triangles[t][(k + 1u) % 3], b = mesh.triangles[t][(k + 2u) % 3];
         sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t), k});
      }
   std::sort(sides.begin(), sides.end(), [](const Side &l, const Side &r) {
      return std::tie(l.low, l.high, l.triangle) < std::tie(r.low, r.high, r.triangle);
   });
   std::vector<std::array<bool, 3>> sharp(mesh.triangles.size(), {true, true, true});
   for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
      const Side &one = sides[i], &two = sides[i + 1];
      if (one.low != two.low || one.high != two.high)
         continue;
      if (normals[one.triangle].dot(normals[two.triangle]) > kSmooth &&
          mesh.materials[one.triangle] == mesh.materials[two.triangle])
         sharp[one.triangle][one.number] = sharp[two.triangle][two.number] = false;
      ++i;
   }
   return sharp;
}

void append(Surface &surface, const Geometry &geometry, const SolidMesh &mesh)
{
   std::vector<Vec3> normals(mesh.triangles.size());
   for (std::size_t t = 0; t < normals.size(); ++t)
      normals[t] = normalOf(mesh, t);
   const auto sharp = sharpEdges(mesh, normals);
   for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto &rgb = geometry.material(mesh.materials[t]).color;
      const double light = shade(normals[t]) / 255;
      for (std::size_t k = 0; k < 3; ++k) {
         const Vec3 place = mesh.vertices[mesh.triangles[t][k]] - surface.anchor;
         Surface::Corner corner{};
         for (std::size_t i = 0; i < 3; ++i) {
            corner.position[i] = static_cast<float>(place[static_cast<Eigen::Index>(i)]);
            corner.edge[i] = sharp[t][i] && i != k ? 1.0f : 0.0f;
            corner.color[i] = static_cast<float>(light * rgb[i]);
         }
         surface.corners.push_back(corner);
      }
   }
}

} // namespace

Result<Surface> surfaceOf(const Hierarchy &hierarchy, const PartMaker *maker, const GeometryOptions &options,
                          const Job &job)
{
   const auto geometry = makeGeometry(hierarchy, maker, options, job);
   if (!geometry)
      return geometry.error();
   if (geometry->triangles() > kMostTriangles)
      return Error{
          ErrorCode::invalid,
          fmt::format("{} triangles are too many to draw, at most {} are; show the cells, draw parts "
                      "in less detail, or export them",
                      geometry->triangles(), kMostTriangles)};
   Surface surface;
   for (const Solid &solid : geometry->solids)
      for (const Vec3 &vertex : solid.mesh.vertices)
         surface.bounds.extend(vertex);
   if (!surface.bounds.isEmpty())
      surface.anchor = surface.bounds.center();
   surface.corners.reserve(3 * geometry->triangles());
   for (const Solid &solid : geometry->solids) {
      if (job.cancelled())
         return Error{ErrorCode::cancelled, "drawing was cancelled"};
      append(surface, *geometry, solid.mesh);
   }
   return surface;
}

Surface surfaceOf(const std::vector<TriangleMesh> &meshes)
{
   constexpr std::array<std::uint8_t, 3> kGrey{150, 160, 175};
   Surface surface;
   std::uint64_t triangles = 0;
   std::size_t drawn = 0;
   for (; drawn < meshes.size(); ++drawn) {
      triangles += meshes[drawn].triangles.size();
      if (triangles > kMostTriangles)
         break;
      const auto bounds = meshes[drawn].bounds();
      surface.bounds.extend(bounds);
   }
   if (!surface.bounds.isEmpty())
      surface.anchor = surface.bounds.center();
   for (std::size_t m = 0; m < drawn; ++m) {
      const TriangleMesh &mesh = meshes[m];
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
         std::array<Vec3, 3> corners;
         for (std::size_t k = 0; k < 3; ++k)
            corners[k] = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
         const Vec3 across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
         const double size = across.norm();
         if (!(size > 0))
            continue;
         const auto &piece = mesh.pieces[static_cast<std::size_t>(mesh.piece[t])];
         const auto &rgb = piece.colored ? piece.color : kGrey;
         const double light = shade(across / size) / 255;
         for (const Vec3 &corner : corners) {
            Surface::Corner out{};
            for (std::size_t i = 0; i < 3; ++i) {
               const auto axis = static_cast<Eigen::Index>(i);
               out.position[i] = static_cast<float>(corner[axis] - surface.anchor[axis]);
               out.color[i] = static_cast<float>(light * rgb[i]);
            }
            surface.corners.push_back(out);
         }
      }
   }
   return surface;
}

} // namespace diatom::render
