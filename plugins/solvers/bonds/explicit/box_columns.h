// Inertia of a cell that is no cube, as the vector kernel takes it.
#pragma once

#include "explicit/sweep.h"

#include <array>

namespace bonds {

/// Columns by BoxColumn, kg m^2 and its inverse: the ball is that of the two principal values that are most
/// alike, or of one of them.
std::array<double, kBoxColumns> boxColumns(const Assembly &assembly, std::int64_t cell);

} // namespace bonds
