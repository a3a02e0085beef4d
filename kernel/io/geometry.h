// What an export holds before it becomes a file: closed solids of cells, parts or struts, by material or as
// one.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"
#include "io/solid_mesh.h"
#include "io/strut_solid.h"
#include "parts/decomposition.h"

#include <optional>
#include <string>
#include <vector>

namespace diatom {

struct Solid
{
   std::string name;
   MaterialIndex material = 0; // 0: each triangle has its own
   SolidMesh mesh;
};

/// Round struts by their axes.
struct BeamSet
{
   std::string name;
   MaterialIndex material = 0;
   std::vector<Vec3> nodes; // m
   std::vector<std::array<std::uint32_t, 2>> beams;
};

struct Geometry
{
   std::vector<Solid> solids;
   std::vector<BeamSet> beams;      // instead of solids, all of the width of `struts`
   std::vector<Material> materials; // of the model; material m is the one before m
   std::uint64_t cells = 0, parts = 0;
   StrutFacts struts; // of an export of struts

   const Material &material(MaterialIndex index) const { return materials[index - std::size_t{1}]; }
   std::uint64_t triangles() const;
   std::uint64_t edgeContacts() const;
   std::uint64_t vertexContacts() const;
};

struct GeometryOptions
{
   enum class What { cells, parts, struts };
   What what = What::cells;
   std::optional<MaterialIndex> material; // only this one
   /// One solid for each material, closed by itself, or one for all, without walls between materials.
   bool apart = true;
   int detail = -1; // of part meshes; -1 = the finest
   StrutOptions struts;
};

/// `maker` is needed for parts only and may be null otherwise.
Result<Geometry> makeGeometry(const Hierarchy &hierarchy, const PartMaker *maker,
                              const GeometryOptions &options, const Job &job);

} // namespace diatom
