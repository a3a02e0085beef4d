// A design as nodes and struts: the edges of its cells, or the connections between their centres, each once.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"
#include "core/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace diatom {

struct Strut
{
   std::uint32_t a = 0, b = 0; // nodes, a < b
   int axis = 0;               // its direction, from a to b or reversed
   bool reversed = false;
   MaterialIndex material = 0; // the smallest of the cells it belongs to
};

/// A direction of struts, one for both ways along it, and a frame across it, the same for all struts of it.
struct StrutAxis
{
   Vec3 along, across, third; // right-handed, unit
};

struct StrutGraph
{
   std::vector<Vec3> nodes; // m
   std::vector<Strut> struts;
   std::vector<StrutAxis> axes;
   /// By node: the struts that end there, in order.
   std::vector<std::vector<std::uint32_t>> at;

   double length(const Strut &strut) const { return (nodes[strut.b] - nodes[strut.a]).norm(); }
   /// Direction in which the strut leaves the node.
   Vec3 leaving(const Strut &strut, std::uint32_t node) const
   {
      const Vec3 &along = axes[static_cast<std::size_t>(strut.axis)].along;
      return (strut.a == node) != strut.reversed ? along : Vec3(-along);
   }
};

/// `connections`: from centre to centre of cells that the lattice joins; else the edges of polyhedra.
Result<StrutGraph> strutGraph(const Hierarchy &hierarchy, bool connections, const Job &job);

} // namespace diatom
