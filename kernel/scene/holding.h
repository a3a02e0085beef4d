// Which freedoms of which cells are held or driven, and entries that contradict each other.
#pragma once

#include "cells/hierarchy.h"
#include "scene/networks.h"
#include "scene/setup.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace diatom {

/// Freedoms that supports hold or curves drive, looked up by cell. The set-up's entries must be well formed.
class Holding
{
public:
   Holding(const Hierarchy &hierarchy, const Setup &setup);
   /// Bit mask as in Support.
   std::uint8_t freedoms(Index cell) const;

private:
   std::vector<std::pair<Index, std::uint8_t>> m_cells; // sorted, each cell once
};

/// What is wrong with a curve: "" or the rest of a sentence, like "has no points".
std::string curveFault(const Curve &curve);

/// Errors "driven-twice" and "held-and-driven", each naming the first cell.
void findConflicts(std::vector<Problem> &problems, const Hierarchy &hierarchy, const Setup &setup);

} // namespace diatom
