// What File > New starts from: an empty assembly with a palette to build with.
#pragma once

#include "document/design.h"

#include <string>

namespace diatom::gui {

/// Lattice by id, pitch 1 mm.
Design defaultDesign(const std::string &lattice);

} // namespace diatom::gui
