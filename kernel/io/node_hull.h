// The joint of several struts: the convex hull of their end polygons (Srinivasan, Mandal and Akleman,
// "Solidifying wireframes", 2005).
#pragma once

#include "core/vec.h"

#include <optional>
#include <span>
#include <vector>

namespace diatom {

/// How far from the node, in radii of the struts, end polygons must stand so that each is a face of the hull:
/// the crotch of two cylinders at angle t lies cot(t/2) radii out. Directions are unit.
double setBack(std::span<const Vec3> leaving);

/// Faces of the hull of all points, counter-clockwise from outside, without the given ones: `ends`
/// consecutive polygons of `sides` points each. Every point must be a corner of the hull. Nothing when
/// rounding gets in the way.
std::optional<std::vector<std::vector<int>>> joiningFaces(std::span<const Vec3> points, int ends, int sides);

} // namespace diatom
