// Composites as boxes, for the hierarchy view and for assemblies too large to draw cell by cell. Sizes come
// from the definitions, each looked at once; nothing is expanded.
#pragma once

#include "cells/hierarchy.h"
#include "render/camera.h"
#include "render/color_map.h"

#include <vector>

namespace diatom::render {

/// A box in space: corners are centre +- axes.
struct SolidBox
{
   Vec3 centre = Vec3::Zero();
   Mat3 axes = Mat3::Identity(); // columns: half edges
   Rgba color;
};

/// One box per instance in the model's root, in its definition's colour; `limit` at most.
std::vector<SolidBox> compositeBoxes(const Lattice &lattice, const Model &model, std::size_t limit = 200'000);

/// The root's own cells as blocks of one material, merged until there are no more than `limit`.
std::vector<SolidBox> blockBoxes(const Lattice &lattice, const Model &model, std::size_t limit = 200'000);

/// The model without its instances: what the hierarchy view draws cell by cell.
Model ownCells(const Model &model);

} // namespace diatom::render
