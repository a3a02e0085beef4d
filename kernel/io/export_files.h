// One export as a user asks for it: the surface of a design to one file or to one for each material, streamed
// where the format lets it be.
#pragma once

#include "io/geometry_file.h"

#include <vector>

namespace diatom {

struct ExportOptions
{
   GeometryFormat format = GeometryFormat::stl;
   GeometryOptions geometry; // STL always holds one solid
   bool eachMaterial = false;
   bool ascii = false; // STL of cells or parts
   double unit = 1e-3; // metres
};

struct ExportedFile
{
   std::filesystem::path file;
   std::optional<MaterialIndex> material; // when it holds only this one
   std::uint64_t solids = 0;              // 0 for a streamed file, which is not divided
   std::uint64_t triangles = 0, bytes = 0, cells = 0, parts = 0;
   StrutFacts struts;
   std::optional<std::uint64_t> edgeContacts, vertexContacts; // where they were counted
};

/// `maker` is needed for parts only. With `eachMaterial` the files are name.MATERIAL.suffix, one for each
/// that occurs. STL of cells or parts is streamed; contacts of it are counted up to a million cells.
Result<std::vector<ExportedFile>> exportFiles(const Hierarchy &hierarchy, const PartMaker *maker,
                                              const ExportOptions &options, const std::filesystem::path &out,
                                              const Job &job);

} // namespace diatom
