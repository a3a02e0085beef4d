// Cells that stand alone become super-cells.
#pragma once

#include "cells/cell_array.h"
#include "lattice/lattice.h"

namespace diatom {

/// Joins every straight row of cells of one material, along the lattice's super-cells, into super-cells of
/// the usual length, shorter ones at its end. Joins that were there are made anew. Nothing on lattices
/// without super-cells.
void joinRuns(CellArray &cells, const Lattice &lattice);

} // namespace diatom
