// A closed surface with indices: what every format but STL is written from.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"
#include "core/vec.h"
#include "io/point_numbers.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace diatom {

/// Triangles counter-clockwise from outside, metres. After splitContacts() a 2-manifold by index, even where
/// several vertices lie at one place.
struct SolidMesh
{
   std::vector<Vec3> vertices;
   std::vector<std::array<std::uint32_t, 3>> triangles;
   std::vector<MaterialIndex> materials; // of each triangle
   /// Places where the solid touches itself along an edge, or at a corner that no such edge ends in.
   std::uint64_t edgeContacts = 0, vertexContacts = 0;
};

/// Collects faces and makes them one solid.
class SolidBuilder
{
public:
   /// A convex face, counter-clockwise from outside. Corners with the very same doubles are one vertex.
   void face(std::span<const Vec3> corners, MaterialIndex material);
   bool empty() const { return m_mesh.triangles.empty(); }
   /// Splits contacts. Refuses more triangles than indices can count, and a surface that is not closed.
   Result<SolidMesh> finish();

private:
   SolidMesh m_mesh;
   PointNumbers m_numbers;
   std::vector<std::uint32_t> m_ring;
   bool m_tooMany = false;
};

/// The outside of all cells as one solid, or of those of one material.
Result<SolidMesh> cellSolid(const Hierarchy &hierarchy, std::optional<MaterialIndex> material,
                            const Job &job);

/// Volume by the divergence theorem, m3.
double volumeOf(const SolidMesh &mesh);

} // namespace diatom
