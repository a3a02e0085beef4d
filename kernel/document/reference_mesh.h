// Meshes of other programs shown beside the cells, to design against: never simulated, exported or made.
#pragma once

#include "core/vec.h"

#include <string>

namespace diatom {

struct ReferenceMesh
{
   std::string name; // one of each in a design
   std::string file; // whole path; in documents from their own folder where it lies below that
   double unit = 0;  // metres per number in the file; 0 = what the file or its format says, or millimetres
   Vec3 position = Vec3::Zero(); // of the file's origin, m
   bool shown = true;

   friend bool operator==(const ReferenceMesh &, const ReferenceMesh &) = default;
};

} // namespace diatom
