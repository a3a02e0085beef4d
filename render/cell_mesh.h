// What of an assembly can be seen: faces that no neighbour covers, sorted for drawing. Cells with none drop
// out.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"
#include "render/camera.h"
#include "render/face_types.h"

#include <cstdint>
#include <vector>

namespace diatom::render {

/// One drawn cell owns a slot; poses and colours are kept by slot, faces refer to slots. A face is four
/// bytes.
struct CellMesh
{
   Vec3 anchor = Vec3::Zero();          // positions are floats relative to this
   std::vector<Index> cells;            // by slot
   std::vector<MaterialIndex> material; // by slot
   std::vector<float> position;         // 4 per slot: x y z about the anchor, 0
   FaceTypes types;
   std::vector<std::uint32_t> faces; // slots; run (t, c) starts at start[t * chunks + c]
   std::vector<std::uint32_t> start;
   std::vector<Eigen::AlignedBox3f> chunks; // about the anchor, cells' bodies included
   Bounds bounds;                           // of the drawn cells, world

   std::uint64_t exposedFaces() const { return faces.size(); }
};

/// Whether faces that a neighbour covers are left out, or drawn for cells that show at all: cells that move
/// apart open gaps through which those would be missed.
enum class Covered { dropped, keptOnSurface };

/// Expands up to `limit` logical cells; the caller checks Hierarchy::cells() first. Errors: more than that,
/// cancelled.
Result<CellMesh> buildCellMesh(const Hierarchy &hierarchy, const Job &job, std::uint64_t limit = 20'000'000,
                               Covered covered = Covered::dropped);

/// Box of the cells at the corners of an index box, in metres, with the cells' bodies.
Bounds worldBounds(const Lattice &lattice, const Box &box);

} // namespace diatom::render
