// What is wrong with a surface that should enclose a solid, and turning its triangles the right way round.
#pragma once

#include "io/triangle_mesh.h"

#include <cstdint>
#include <string>

namespace diatom {

/// Corners at the same place count as one.
struct MeshFaults
{
   std::uint64_t flat = 0;    // triangles without area
   std::uint64_t open = 0;    // edges of one triangle: the rim of a hole
   std::uint64_t opposed = 0; // edges of two triangles that look to different sides
   std::uint64_t uneven = 0;  // edges of more than two, where those one way and the other do not cancel
   /// Winding numbers are whole all over space.
   bool closed() const { return open == 0 && opposed == 0 && uneven == 0; }

   /// One sentence for the user; empty when the mesh is closed.
   std::string text() const;
};

MeshFaults findFaults(const TriangleMesh &mesh);

/// Turns triangles round where a connected part has neighbours that look to different sides, so that they
/// agree and look outward; then all of them when the whole encloses a negative volume. Parts that agree
/// already stay as they are: one that looks inward is a cavity. Returns how many were turned.
std::uint64_t orientTriangles(TriangleMesh &mesh);

} // namespace diatom
