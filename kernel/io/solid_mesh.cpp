#include "io/solid_mesh.h"

#include "io/split_contacts.h"
#include "io/surface.h"

#include <bit>
#include <limits>

namespace diatom {

std::size_t PointNumbers::Hash::operator()(const std::array<double, 3> &point) const
{
   std::uint64_t hash = 0;
   for (const double number : point) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(number)) * 0x9e37'79b9'7f4a'7c15u;
      hash ^= hash >> 29;
   }
   return hash;
}

std::uint32_t PointNumbers::number(const Vec3 &point)
{
   // 0 and -0 are one place.
   const std::array<double, 3> key{point.x() + 0.0, point.y() + 0.0, point.z() + 0.0};
   const auto [found, added] = m_numbers.emplace(key, static_cast<std::uint32_t>(m_points.size()));
   if (added)
      m_points.push_back(point);
   return found->second;
}

Result<SolidMesh> cellSolid(const Hierarchy &hierarchy, std::optional<MaterialIndex> material, const Job &job,
                            const std::function<Vec3(const Vec3 &)> &moved)
{
   SolidMesh mesh;
   PointNumbers numbers(mesh.vertices);
   std::vector<std::uint32_t> ring;
   constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() / 3;
   bool tooMany = false;
   const Status seen = visitSurface(
       hierarchy, material, false,
       [&](const SurfaceFace &face) {
          tooMany = tooMany || mesh.triangles.size() + face.corners.size() > kMost;
          if (tooMany)
             return;
          ring.clear();
          for (const Vec3 &corner : face.corners)
             ring.push_back(numbers.number(corner));
          for (std::size_t i = 2; i < ring.size(); ++i) {
             mesh.triangles.push_back({ring[0], ring[i - 1], ring[i]});
             mesh.materials.push_back(face.material);
          }
       },
       job);
   if (!seen)
      return seen.error();
   if (tooMany)
      return Error{ErrorCode::invalid, "the surface has more triangles than a mesh with indices can count; "
                                       "export it by material, in pieces or as STL"};
   if (const Status split = splitContacts(mesh); !split)
      return split.error();
   if (moved)
      for (Vec3 &vertex : mesh.vertices)
         vertex = moved(vertex);
   return mesh;
}

double volumeOf(const SolidMesh &mesh)
{
   double sum = 0;
   for (const auto &[a, b, c] : mesh.triangles) {
      const Vec3 &from = mesh.vertices[mesh.triangles[0][0]]; // against cancellation far from the origin
      sum += (mesh.vertices[a] - from).dot((mesh.vertices[b] - from).cross(mesh.vertices[c] - from)) / 6;
   }
   return sum;
}

} // namespace diatom
