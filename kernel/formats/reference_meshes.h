// The meshes that a design is shown against, read from their files.
#pragma once

#include "core/job.h"
#include "document/reference_mesh.h"
#include "io/triangle_mesh.h"

#include <string>
#include <vector>

namespace diatom {

struct LoadedReferences
{
   std::vector<TriangleMesh> meshes; // in place, m
   /// One for each that is shown but cannot be read, with the remedy: the design itself is not at fault.
   std::vector<std::string> notes;
};

/// Reads the meshes that are shown. Errors: cancelled.
Result<LoadedReferences> loadReferenceMeshes(const std::vector<ReferenceMesh> &references, const Job &job);

} // namespace diatom
