// The surface of an assembly: the faces of cells that no cell of the same export covers, as a stream of
// polygons.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"

#include <functional>
#include <optional>
#include <span>

namespace diatom {

/// One exposed face. Corners are canonical: cells that share a corner give the very same doubles.
struct SurfaceFace
{
   Index cell;
   int face = 0;
   MaterialIndex material = 0;
   std::span<const Vec3> corners; // counter-clockwise from outside, m
};

/// Streams every exposed face. With `material`, only cells of it exist; `insideMaterials` also shows faces
/// between different materials. Nothing is expanded beyond a brick at a time.
Status visitSurface(const Hierarchy &hierarchy, std::optional<MaterialIndex> material, bool betweenMaterials,
                    const std::function<void(const SurfaceFace &)> &visit, const Job &job);

} // namespace diatom
