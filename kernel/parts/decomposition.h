// Cells become parts: runs a parts plugin over a model, checks what it returns, lists and meshes the parts.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "plugins/catalogue.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace diatom {

/// A part type on offer.
struct PartType
{
   std::string id, name;
   int share = 1; // parts of this type that together cover one cell
};

/// One placed part.
struct Part
{
   int type = 0;
   int length = 1; // cells in the run it fills
   MaterialIndex material = 0;
   Vec3 position = Vec3::Zero(); // m
   Quat orientation = Quat::Identity();
   std::int64_t firstCell = 0, cells = 0; // into Decomposition::covered
};

/// Triangles in metres, outward.
struct Mesh
{
   std::vector<Vec3> vertices;
   std::vector<std::array<std::int32_t, 3>> triangles;
};

/// Result of decomposing a whole model: parts in a fixed order, the cells each covers, and the cells left
/// over.
struct Decomposition
{
   std::vector<PartType> types;
   std::vector<Part> parts;
   std::vector<Index> covered; // world indices, by part
   std::vector<Index> left;    // cells no part covers; only where the plugin says "partial"
};

/// A parts plugin's instance. Any thread.
class PartMaker
{
public:
   /// `id` of the plugin's thing; empty picks the first installed one that fits the lattice by name.
   static Result<std::shared_ptr<const PartMaker>> make(const Catalogue &catalogue, const std::string &id,
                                                        const Values &values, const std::string &lattice,
                                                        const Job &job);

   const std::string &id() const;
   const std::vector<PartType> &types() const;
   /// Ids of the lattices it fits; "*" fits any.
   const std::vector<std::string> &lattices() const;
   /// Whether cells may stay uncovered.
   bool partial() const;
   int details() const;
   /// Refuses, naming the first bad cell, when the plugin covers a cell twice or not at all, or returns bad
   /// poses.
   Result<Decomposition> decompose(const Hierarchy &hierarchy, const Job &job) const;
   /// Mesh of one part in its own frame, metres. detail 0 for thousands on screen, details()-1 for
   /// manufacture.
   Result<Mesh> mesh(int type, int length, int detail, double pitch, const Job &job) const;

   ~PartMaker();

private:
   PartMaker();
   struct Self;
   std::unique_ptr<Self> m_self;
};

} // namespace diatom
