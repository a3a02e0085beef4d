#include "io/index_frame.h"

#include <cmath>

namespace diatom {

IndexFrame::IndexFrame(const Lattice &lattice) : m_radius(lattice.radius())
{
   const auto period = lattice.period();
   const Vec3 origin = lattice.position({});
   m_basis.col(0) = (lattice.position({period[0], 0, 0}) - origin) / period[0];
   m_basis.col(1) = (lattice.position({0, period[1], 0}) - origin) / period[1];
   m_basis.col(2) = (lattice.position({0, 0, period[2]}) - origin) / period[2];
   m_inverse = m_basis.inverse();
   Index i;
   for (i.x = 0; i.x < period[0]; ++i.x)
      for (i.y = 0; i.y < period[1]; ++i.y)
         for (i.z = 0; i.z < period[2]; ++i.z)
            m_offset.extend(Vec3(lattice.position(i) - m_basis * Vec3(i.x, i.y, i.z)));
}

Eigen::AlignedBox3d IndexFrame::space(const Box &indices) const
{
   Eigen::AlignedBox3d box;
   for (int corner = 0; corner < 8; ++corner)
      box.extend(Vec3(m_basis * Vec3(corner & 1 ? indices.max.x : indices.min.x,
                                     corner & 2 ? indices.max.y : indices.min.y,
                                     corner & 4 ? indices.max.z : indices.min.z)));
   return {box.min() + m_offset.min() - Vec3::Constant(m_radius),
           box.max() + m_offset.max() + Vec3::Constant(m_radius)};
}

IndexFrame::Range IndexFrame::indices(const Eigen::AlignedBox3d &space) const
{
   const Eigen::AlignedBox3d wide(space.min() - m_offset.max() - Vec3::Constant(m_radius),
                                  space.max() - m_offset.min() + Vec3::Constant(m_radius));
   Eigen::AlignedBox3d box;
   for (int corner = 0; corner < 8; ++corner)
      box.extend(Vec3(m_inverse * wide.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner))));
   Range range;
   for (int axis = 0; axis < 3; ++axis) {
      range.min[static_cast<std::size_t>(axis)] = std::floor(box.min()[axis]);
      range.max[static_cast<std::size_t>(axis)] = std::ceil(box.max()[axis]);
   }
   return range;
}

} // namespace diatom
