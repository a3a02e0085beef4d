// STL out: of cells or of parts, all or one material, binary or ASCII, streamed and written atomically.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"
#include "parts/decomposition.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace diatom {

struct StlOptions
{
   enum class What { cells, parts };
   What what = What::cells;
   std::optional<MaterialIndex> material; // only this one
   bool ascii = false;
   int detail = -1;    // of part meshes; -1 = the finest
   double unit = 1e-3; // metres per STL unit: millimetres by custom
   bool contacts =
       false; // also count where cells touch only at edges and corners; holds the surface in memory
   /// Where a corner of cells is to be, from where it is at rest; none leaves them at rest.
   std::function<Vec3(const Vec3 &)> moved;
};

struct StlReport
{
   std::filesystem::path file;
   std::optional<MaterialIndex> material; // when the file holds only this one
   std::uint64_t triangles = 0, bytes = 0;
   std::uint64_t cells = 0, parts = 0;
   std::optional<std::uint64_t> edgeContacts, vertexContacts; // of cells, when asked for
};

/// `maker` is needed for parts only and may be null otherwise.
Result<StlReport> writeStl(const Hierarchy &hierarchy, const PartMaker *maker, const StlOptions &options,
                           const std::filesystem::path &file, const Job &job);
/// One file per material that occurs: name.MATERIAL.stl beside `file`.
Result<std::vector<StlReport>> writeStlByMaterial(const Hierarchy &hierarchy, const PartMaker *maker,
                                                  const StlOptions &options,
                                                  const std::filesystem::path &file, const Job &job);

} // namespace diatom
