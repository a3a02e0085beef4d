// Meshes of other programs as designs: the solid within the surface as cells of a lattice.
#pragma once

#include "core/job.h"
#include "formats/files.h"
#include "io/voxelize.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace diatom {

struct MeshImport
{
   double unit = 0;        // metres per number in the file; 0 = what the format says, or millimetres
   double size = 0;        // the longest side is scaled to this, m; 0 = as it is
   bool keepPlace = false; // else the mesh is moved to where cell 0, 0, 0 begins
   BoundaryRule rule = BoundaryRule::centre;
   double fraction = 0.5;
   /// Id of the material; empty = one per piece or colour of the mesh.
   std::string material;
   /// Cells inside another mesh, in the same place and scale, are of this material. Later ones win.
   std::vector<std::pair<std::filesystem::path, std::string>> inside;
};

/// Notes tell what the mesh is, its faults, and what was assumed. On lattices of super-cells rows of cells
/// become super-cells of the usual length.
Result<Opened> importMesh(const std::filesystem::path &file, const MeshImport &options,
                          const Lattice &lattice, const Job &job);

} // namespace diatom
