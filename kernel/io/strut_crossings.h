// Where struts cross or lie on each other, they get a common node and are cut there.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/vec.h"

#include <cstdint>
#include <vector>

namespace diatom {

struct StrutLine
{
   std::uint32_t a = 0, b = 0;
   MaterialIndex material = 0;
};

/// Returns the pieces of all lines, none twice; nodes are added where lines cross. Lines whose distance is
/// below a millionth of the longest one's length meet.
std::vector<StrutLine> cutAtCrossings(const std::vector<StrutLine> &lines, std::vector<Vec3> &nodes,
                                      const Job &job);

} // namespace diatom
