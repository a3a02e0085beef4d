// What a shape of a motif must be: a closed convex polyhedron about the origin, with rotations that are its
// own.
#pragma once

#include "lattice/lattice.h"

#include <diatom/abi/lattice.h>

#include <array>
#include <vector>

namespace diatom {

struct CheckedShape
{
   Shape shape;                 // lattice units
   double inner = 0, outer = 0; // radii of the balls about the origin inside and around it
};

/// Shape `number` of the motif, or its first fault. The start arrays up to it have been checked.
Result<CheckedShape> checkShape(const diatom_motif &motif, int number);

/// Edges of a polyhedron in order of first appearance when walking the faces; smaller vertex number first.
std::vector<std::array<int, 2>> edgesOf(const std::vector<std::vector<int>> &faces);

/// All within 1e6 of zero, and no NaN.
bool allFinite(const double *values, int count);
/// No count falls, or is above `largest`.
bool rises(const std::int32_t *start, int count, int largest);
/// A unit quaternion.
bool unit(const double *quaternion);

} // namespace diatom
