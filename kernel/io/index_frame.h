// Where boxes of indices lie in space, and which indices a box in space may hold.
#pragma once

#include "lattice/lattice.h"

namespace diatom {

class IndexFrame
{
public:
   explicit IndexFrame(const Lattice &lattice);

   /// Holds every cell of the box, whole. m.
   Eigen::AlignedBox3d space(const Box &indices) const;
   /// Holds the index of every cell that meets the space; not limited to the range of indices.
   struct Range
   {
      std::array<double, 3> min{}, max{};
   };
   Range indices(const Eigen::AlignedBox3d &space) const;

private:
   Mat3 m_basis, m_inverse;      // columns: steps per index
   Eigen::AlignedBox3d m_offset; // of the sites
   double m_radius;
};

} // namespace diatom
