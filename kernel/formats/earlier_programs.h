// Files of the earlier programs, out: what AMOEBA and DMDesign open.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "document/design.h"

#include <string>
#include <vector>

namespace diatom {

/// Cubes only, 1 mm or 1 um; materials become the program's own, by id or else by their electrical role, with
/// a note. Composites are written as their cells.
Result<std::string> writeAmoeba(const Design &design, const Hierarchy &hierarchy,
                                std::vector<std::string> &notes, const Job &job);

/// Assembly and composites on any of the program's lattices; runs of cells as bricks. Refuses turned
/// composites and turned cells, which the program does not have. Simulation is lost.
Result<std::string> writeDmdesign(const Design &design, const Hierarchy &hierarchy,
                                  std::vector<std::string> &notes, const Job &job);

} // namespace diatom
