// A solid given by its surface becomes cells of any lattice.
#pragma once

#include "cells/cell_array.h"
#include "core/job.h"
#include "core/result.h"
#include "io/triangle_tree.h"
#include "lattice/lattice.h"

#include <functional>

namespace diatom {

/// When a cell that the surface cuts belongs to the solid. Cells that it does not cut are wholly in or out.
enum class BoundaryRule {
   centre,  // its centre is inside
   touch,   // any of it is inside
   fraction // at least a given part of its volume is inside
};

struct VoxelizeOptions
{
   BoundaryRule rule = BoundaryRule::centre;
   double fraction = 0.5; // of the cell's volume, above 0 up to 1; told apart in steps of 1/64
   bool closed = false; // the surface has no holes: blocks of cells that it does not meet are decided at once
   MaterialIndex material = 1;
   /// Tells the material of an inner cell where there are several; called from several threads at once.
   std::function<MaterialIndex(Index cell, const Vec3 &centre)> materialAt;
};

/// Inside is where the winding number exceeds a half; a centre on the surface itself counts as if it lay a
/// little higher in x, y and z, so that of two solids that share a face each cell is in one. The cells are
/// the same on any number of threads. Refuses surfaces that would need more cells than can be looked at.
Result<CellArray> voxelize(const TriangleTree &tree, const Lattice &lattice, const VoxelizeOptions &options,
                           const Job &job);

} // namespace diatom
