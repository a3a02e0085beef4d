// The cells that an entry of the set-up is on: named in words, and looked up in a design.
#pragma once

#include "cells/hierarchy.h"
#include "scene/setup.h"

#include <cstddef>
#include <string>
#include <vector>

namespace diatom {

/// Cells that are looked through at most for those wanted: as many as can be simulated at once.
inline constexpr std::int64_t kMostSearched = 20'000'000;

/// "(1, 2, 3)".
std::string indexText(Index cell);
/// "cell (1, 2, 3)", "box (0, 0, 0) to (4, 4, 4)", "material brass".
std::string whereText(const Where &where);
/// Whether it is one cell, a box with its lowest corner first, or a material by its id.
bool wellFormed(const Where &where);

/// Whether the design has a cell there; false where the entry is not well formed.
bool anyCell(const Hierarchy &hierarchy, const Where &where);
/// Up to `most` of its cells, sorted. Cells of a material that turn up late in a very large design are left
/// out.
std::vector<Index> someCells(const Hierarchy &hierarchy, const Where &where, std::size_t most);

/// Order of entries in a set-up: cells, boxes, materials, each ascending.
bool before(const Where &a, const Where &b);

} // namespace diatom
