// What a mesh is before it becomes cells: for those who choose how it is to.
#pragma once

#include "core/job.h"
#include "io/voxelize.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace diatom {

struct MeshFacts
{
   std::uint64_t triangles = 0;
   std::size_t pieces = 0;   // bodies or colours that would be materials of their own
   Vec3 size = Vec3::Zero(); // in numbers of the file
   double volume = 0;        // enclosed, likewise; of a mesh with holes about
   double area = 0;          // likewise
   double customaryUnit = 0; // metres per number, if the file or its format says or else by custom
   std::string faults;       // one sentence; empty for a closed surface
};

Result<MeshFacts> lookAtMesh(const std::filesystem::path &file, const Job &job);

/// About how many cells it makes with `unit` metres per number: its volume by that of a cell; where cells
/// count that it only touches, a layer of half their mean width is added. An estimate, best for bodies much
/// larger than a cell.
double cellsAbout(const MeshFacts &facts, double unit, BoundaryRule rule, const Lattice &lattice);

} // namespace diatom
