// The solid of a cell as half-spaces: whether a triangle enters it, and points spread evenly in it.
#pragma once

#include "lattice/lattice.h"

#include <array>
#include <vector>

namespace diatom {

/// Of one site of a lattice, about the cell's centre. Any thread.
class CellSolid
{
public:
   CellSolid(const Lattice &lattice, int site);

   /// Whether part of the triangle lies in the inside; a touch at the boundary is none. Corners relative to
   /// the centre, m.
   bool entered(const std::array<Vec3, 3> &triangle) const;
   /// As many points of the inside as a fraction is counted with.
   const std::vector<Vec3> &samples() const { return m_samples; }

private:
   struct Plane
   {
      Vec3 normal;
      double offset; // inside: normal . p < offset
   };
   bool inside(const Vec3 &point) const;

   std::vector<Plane> m_planes;
   std::vector<Vec3> m_samples;
};

} // namespace diatom
