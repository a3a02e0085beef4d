// A triangle mesh from outside, as read: nothing is promised about it but that its numbers are finite.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace diatom {

struct TriangleMesh
{
   /// What the file keeps apart: a body, a group, a material.
   struct Piece
   {
      std::string name; // of its material or else of itself; may be empty
      std::array<std::uint8_t, 3> color{0x80, 0x80, 0x80};
      bool colored = false; // the file says the colour
   };

   std::vector<Vec3> vertices; // m
   std::vector<std::array<std::int32_t, 3>> triangles;
   std::vector<std::int32_t> piece; // per triangle
   std::vector<Piece> pieces;

   Eigen::AlignedBox3d bounds() const
   {
      Eigen::AlignedBox3d box;
      for (const Vec3 &vertex : vertices)
         box.extend(vertex);
      return box;
   }
};

} // namespace diatom
