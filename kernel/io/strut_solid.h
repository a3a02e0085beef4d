// Struts and nodes as closed solids: one union without inner walls, or a shell for each strut.
#pragma once

#include "io/solid_mesh.h"
#include "io/strut_graph.h"

#include <map>

namespace diatom {

struct StrutOptions
{
   double width = 0;         // m, of a square's side or a round's diameter; 0 = chosen for the design
   int sides = 8;            // of the section; 4 is a square
   bool connections = false; // centre to centre of joined cells instead of edges of polyhedra
   bool overlapping = false; // each strut a shell of its own from node to node: quick, at any width
   bool beams = false;       // no surface at all: axes and radius, for formats that know beams
};

struct StrutFacts
{
   double width = 0, widest = 0; // m; 0 for no limit
   std::uint64_t struts = 0, nodes = 0;
};

/// The solids of each material; 0 for one of all when not `apart`. A node belongs to the smallest material of
/// its struts; where a strut of another material meets it, both have a wall.
Result<std::map<MaterialIndex, SolidMesh>> strutSolids(const StrutGraph &graph, const StrutOptions &options,
                                                       bool apart, StrutFacts &facts, const Job &job);

/// The width that is taken: as asked for, refused with the remedy when too thick; by default a fifth of the
/// shortest strut, or six tenths of the widest that can be made where that is less.
Result<StrutFacts> strutFacts(const StrutGraph &graph, const StrutOptions &options, const Job &job);

} // namespace diatom
