// The meshes that a design is shown against, read from their files.
#pragma once

#include "core/job.h"
#include "document/design.h"
#include "io/triangle_mesh.h"

#include <filesystem>
#include <string>
#include <vector>

namespace diatom {

struct LoadedReferences
{
   std::vector<TriangleMesh> meshes; // in place, m
   /// One for each that is shown but cannot be read, with the remedy: the design itself is not at fault.
   std::vector<std::string> notes;
};

/// Reads the meshes that are shown; `folder` is the document's. Errors: cancelled.
Result<LoadedReferences> loadReferenceMeshes(const Design &design, const std::filesystem::path &folder,
                                             const Job &job);

} // namespace diatom
