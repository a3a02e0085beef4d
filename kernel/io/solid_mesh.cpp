#include "io/solid_mesh.h"

#include "io/split_contacts.h"
#include "io/surface.h"

#include <limits>

namespace diatom {

namespace {

/// Half-edges are numbered with 32 bits.
constexpr std::size_t kMostTriangles = std::numeric_limits<std::uint32_t>::max() / 3;

} // namespace

void SolidBuilder::face(std::span<const Vec3> corners, MaterialIndex material)
{
   m_tooMany = m_tooMany || m_mesh.triangles.size() + corners.size() > kMostTriangles;
   if (m_tooMany)
      return;
   m_ring.clear();
   for (const Vec3 &corner : corners)
      m_ring.push_back(m_numbers.number(corner, m_mesh.vertices));
   for (std::size_t i = 2; i < m_ring.size(); ++i) {
      m_mesh.triangles.push_back({m_ring[0], m_ring[i - 1], m_ring[i]});
      m_mesh.materials.push_back(material);
   }
}

Result<SolidMesh> SolidBuilder::finish()
{
   m_numbers.clear();
   if (m_tooMany)
      return Error{ErrorCode::invalid, "the surface has more triangles than a mesh with indices can count; "
                                       "export it by material, in pieces or as STL"};
   if (const Status split = splitContacts(m_mesh); !split)
      return split.error();
   return std::move(m_mesh);
}

Result<SolidMesh> cellSolid(const Hierarchy &hierarchy, std::optional<MaterialIndex> material, const Job &job)
{
   SolidBuilder builder;
   const Status seen = visitSurface(
       hierarchy, material, false,
       [&](const SurfaceFace &face) { builder.face(face.corners, face.material); }, job);
   if (!seen)
      return seen.error();
   return builder.finish();
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
