// A closed surface with indices: what every format but STL is written from.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"
#include "core/vec.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
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

/// Numbers points by their exact doubles, in the order they come.
class PointNumbers
{
public:
   explicit PointNumbers(std::vector<Vec3> &points) : m_points(points) {}
   std::uint32_t number(const Vec3 &point);

private:
   struct Hash
   {
      std::size_t operator()(const std::array<double, 3> &point) const;
   };
   std::vector<Vec3> &m_points;
   std::unordered_map<std::array<double, 3>, std::uint32_t, Hash> m_numbers;
};

/// The outside of all cells as one solid, or of those of one material. Refuses more than an index can count.
Result<SolidMesh> cellSolid(const Hierarchy &hierarchy, std::optional<MaterialIndex> material, const Job &job,
                            const std::function<Vec3(const Vec3 &)> &moved = {});

/// Volume by the divergence theorem, m3.
double volumeOf(const SolidMesh &mesh);

} // namespace diatom
