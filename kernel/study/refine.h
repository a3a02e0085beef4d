// A scene with each cell cut into smaller ones of the same stuff.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"
#include "scene/setup.h"

#include <memory>

namespace diatom {

struct RefinedScene
{
   std::shared_ptr<const Hierarchy> hierarchy;
   Setup setup;
};

/// Cuts every cell into times^3. Cell i becomes times * i ... times * i + times - 1 per axis, so that the
/// whole moves by (times - 1) / (2 times) of the pitch. Supports and drives hold and lead all parts of a
/// cell, loads are shared evenly among them, and the ground's constants are shared among those on a cell's
/// lower face. Errors: a lattice of other cells than cubes; super-cells; materials given by bond constants,
/// which belong to one size of cell; wiring, whose contacts would not be the same; driven turns; cancelled;
/// too many cells.
Result<RefinedScene> refineScene(const std::shared_ptr<const Hierarchy> &hierarchy, const Setup &setup,
                                 const Catalogue &catalogue, int times, const Job &job);

/// The first of the times^3 cells that a cell becomes.
constexpr Index refinedIndex(Index cell, int times) { return cell * times; }

} // namespace diatom
