// The parts that a design says it is made of, or that were asked for instead.
#pragma once

#include "assembly/plan.h"
#include "parts/decomposition.h"

#include <memory>
#include <string>

namespace diatom {

/// `asked` is an id, or empty for what the set-up says (or else what fits the lattice). Values of the set-up
/// go with its own parts only. Errors: not installed, or not for this lattice.
Result<std::shared_ptr<const PartMaker>> chosenParts(const Catalogue &catalogue, const AssemblySetup &setup,
                                                     const std::string &asked, const std::string &lattice,
                                                     const Job &job);

} // namespace diatom
