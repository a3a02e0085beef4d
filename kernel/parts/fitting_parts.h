// The ways in which cells of a lattice can be made of parts.
#pragma once

#include "parts/decomposition.h"

namespace diatom {

/// Of the installed plugins those that fit the lattice: first those that name it, as PartMaker::make() would
/// choose, then those that fit any.
std::vector<std::shared_ptr<const PartMaker>> fittingParts(const Catalogue &catalogue,
                                                           const std::string &lattice, const Job &job);

} // namespace diatom
