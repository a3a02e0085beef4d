// What a motif must be before the kernel relies on it.
#pragma once

#include "lattice/lattice.h"

#include <diatom/abi/lattice.h>

#include <vector>

namespace diatom {

/// The motif's shapes, in lattice units, when nothing is wrong with it; else the first fault as a clause
/// without the plugin's name. Array lengths cannot be known and are taken from the counts, which are bounded.
Result<std::vector<Shape>> checkMotif(const diatom_motif &motif);

} // namespace diatom
