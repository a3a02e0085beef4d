#include "io/surface_tables.h"

#include <algorithm>
#include <cstdlib>

namespace diatom {

SurfaceTables::SurfaceTables(const Lattice &lattice) : m_lattice(lattice)
{
   const auto period = lattice.period();
   m_faces.resize(static_cast<std::size_t>(lattice.sites()));
   m_owners.resize(static_cast<std::size_t>(lattice.sites()));
   Index i;
   for (i.x = 0; i.x < period[0]; ++i.x)
      for (i.y = 0; i.y < period[1]; ++i.y)
         for (i.z = 0; i.z < period[2]; ++i.z) {
            const int site = lattice.site(i);
            const Shape &shape = lattice.shape(site);
            auto &owners = m_owners[static_cast<std::size_t>(site)];
            for (int vertex = 0; vertex < static_cast<int>(shape.vertices.size()); ++vertex)
               owners.push_back(ownerOf(site, i, vertex));
            for (int face = 0; face < static_cast<int>(shape.faces.size()); ++face) {
               FaceTable table;
               if (const Link *link = lattice.acrossFace(site, face)) {
                  table.linked = true;
                  table.across = link->offset;
                  m_halo = std::max(
                      {m_halo, std::abs(link->offset.x), std::abs(link->offset.y), std::abs(link->offset.z)});
               }
               m_allLinked = m_allLinked && table.linked;
               for (const int vertex : shape.faces[static_cast<std::size_t>(face)])
                  table.corners.push_back(owners[static_cast<std::size_t>(vertex)]);
               m_faces[static_cast<std::size_t>(site)].push_back(std::move(table));
            }
         }
}

CornerOwner SurfaceTables::ownerOf(int site, Index representative, int vertex) const
{
   // Different corners of a lattice are a good part of a cell apart; the same corner computed twice differs
   // by rounding.
   const double tolerance = 1e-6 * m_lattice.radius();
   const Vec3 centre = m_lattice.position(representative);
   const Vec3 point = centre + m_lattice.corners(site)[static_cast<std::size_t>(vertex)];
   CornerOwner owner{{}, vertex};
   // Cells that share a corner touch, hence are linked.
   for (const Link &link : m_lattice.links(site)) {
      if (!(link.offset < owner.offset))
         continue;
      const Index other = representative + link.offset;
      const auto corners = m_lattice.corners(m_lattice.site(other));
      const Vec3 wanted = point - m_lattice.position(other);
      for (std::size_t k = 0; k < corners.size(); ++k)
         if ((corners[k] - wanted).norm() < tolerance)
            owner = {link.offset, static_cast<int>(k)};
   }
   return owner;
}

Vec3 SurfaceTables::corner(Index cell, const CornerOwner &owner) const
{
   const Index at = cell + owner.offset;
   return m_lattice.position(at) +
          m_lattice.corners(m_lattice.site(at))[static_cast<std::size_t>(owner.vertex)];
}

} // namespace diatom
