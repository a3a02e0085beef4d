// All cells of a hierarchy as the flat arrays that a parts plugin reads, in index order, with their runs.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"

#include <diatom/abi/parts.h>

#include <vector>

namespace diatom {

struct GatheredCells
{
   std::vector<Index> index;
   std::vector<std::int32_t> site, material, supercell, place;
   std::vector<double> position, orientation;

   /// Points into this object.
   /// Points into this and into `lattice`.
   diatom_cells record(const LatticeSpec &lattice) const;
};

/// Refuses more cells than the plugin contract can number and orientations that a cell's shape does not have.
Result<GatheredCells> gatherCells(const Hierarchy &hierarchy, const Job &job);

} // namespace diatom
