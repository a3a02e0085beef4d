#include "render/face_types.h"

#include <cmath>
#include <optional>

namespace diatom::render {

namespace {

/// One coordinate per pair of parallel edges (1 on one, -1 on the other) or per single edge (1 on it, 0 at
/// the farthest corner). Nothing when the polygon needs more than four.
std::optional<std::vector<Eigen::Vector4f>> edgeCoordinates(const std::vector<Vec3> &polygon,
                                                            const Vec3 &normal)
{
   const std::size_t n = polygon.size();
   std::vector<Eigen::Vector4f> result(n, Eigen::Vector4f::Zero());
   std::vector<bool> done(n, false);
   int used = 0;
   for (std::size_t i = 0; i < n; ++i) {
      if (done[i])
         continue;
      if (used == 4)
         return std::nullopt;
      const auto direction = [&](std::size_t e) -> Vec3 {
         return (polygon[(e + 1) % n] - polygon[e]).normalized();
      };
      const Vec3 inward = normal.cross(direction(i));
      double width = 0;
      for (const Vec3 &corner : polygon)
         width = std::max(width, inward.dot(corner - polygon[i]));
      bool paired = false;
      for (std::size_t j = i + 1; j < n; ++j)
         if (direction(j).dot(direction(i)) < -1 + 1e-9) {
            done[j] = true;
            paired = true;
         }
      for (std::size_t k = 0; k < n; ++k) {
         const double fraction = inward.dot(polygon[k] - polygon[i]) / width;
         result[k][used] = static_cast<float>(paired ? 1 - 2 * fraction : 1 - fraction);
      }
      ++used;
   }
   return result;
}

FaceType makeType(const std::vector<Vec3> &polygon, int site, int face)
{
   FaceType type;
   type.site = site;
   type.face = face;
   const Vec3 normal = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[1]).normalized();
   type.normal = normal.cast<float>();
   if (const auto edges = edgeCoordinates(polygon, normal)) {
      for (std::size_t i = 0; i < polygon.size(); ++i)
         type.fan.push_back({polygon[i].cast<float>(), (*edges)[i]});
      return type;
   }
   // Many directions (a heptagon, say): a fan about the middle, where the distance to the rim is one
   // coordinate.
   Vec3 middle = Vec3::Zero();
   for (const Vec3 &corner : polygon)
      middle += corner / double(polygon.size());
   type.fan.push_back({middle.cast<float>(), Eigen::Vector4f::Zero()});
   for (std::size_t i = 0; i <= polygon.size(); ++i)
      type.fan.push_back({polygon[i % polygon.size()].cast<float>(), Eigen::Vector4f(1, 0, 0, 0)});
   return type;
}

} // namespace

FaceTypes faceTypes(const Lattice &lattice)
{
   FaceTypes result;
   for (int site = 0; site < lattice.sites(); ++site) {
      result.start.push_back(static_cast<int>(result.types.size()));
      const auto corners = lattice.corners(site);
      const auto &faces = lattice.shape(site).faces;
      for (std::size_t face = 0; face < faces.size(); ++face) {
         std::vector<Vec3> polygon;
         for (const int v : faces[face])
            polygon.push_back(corners[static_cast<std::size_t>(v)]);
         result.types.push_back(makeType(polygon, site, static_cast<int>(face)));
      }
   }
   result.start.push_back(static_cast<int>(result.types.size()));
   return result;
}

std::vector<Vec3> faceCorners(const Lattice &lattice, Index cell, int face)
{
   const int site = lattice.site(cell);
   const auto corners = lattice.corners(site);
   const Vec3 centre = lattice.position(cell);
   std::vector<Vec3> result;
   for (const int v : lattice.shape(site).faces[static_cast<std::size_t>(face)])
      result.push_back(centre + corners[static_cast<std::size_t>(v)]);
   return result;
}

} // namespace diatom::render
