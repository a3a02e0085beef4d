// Solids of an export as they are drawn: triangles, with lines along their sharp edges.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "io/geometry.h"
#include "io/triangle_mesh.h"
#include "render/camera.h"

#include <vector>

namespace diatom::render {

struct Surface
{
   /// Three per triangle.
   struct Corner
   {
      float position[3]; // about the anchor
      /// By edge, opposite to each corner: rises over the triangle to 1 on a sharp edge; 0 for a smooth one.
      float edge[3];
      float color[3]; // lit
   };
   Vec3 anchor = Vec3::Zero();
   std::vector<Corner> corners;
   Bounds bounds; // world
};

/// What makeGeometry() makes of the design, in the colours of its materials. Refuses more than can be drawn.
Result<Surface> surfaceOf(const Hierarchy &hierarchy, const PartMaker *maker, const GeometryOptions &options,
                          const Job &job);

/// Meshes of other programs, without lines: nothing tells their sharp edges. Those that would be too much to
/// draw are left out from the first on.
Surface surfaceOf(const std::vector<TriangleMesh> &meshes);

} // namespace diatom::render
