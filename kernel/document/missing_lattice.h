// Designs whose lattice is not installed: they open and save unchanged, and this is what can be said of them.
#pragma once

#include "document/design.h"
#include "plugins/catalogue.h"

#include <cstdint>
#include <string>

namespace diatom {

/// A sentence for the user; empty when the lattice is installed.
std::string missingLattice(const Design &design, const Catalogue &catalogue);
/// Cells as they are stored: those of a composite once, wherever it is placed.
std::uint64_t storedCells(const Model &model);

} // namespace diatom
