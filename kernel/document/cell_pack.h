// Cells as bytes, for documents too large to be read by people. The layout is described in
// docs/file-format.md.
#pragma once

#include "cells/cell_array.h"
#include "core/job.h"
#include "document/cell_text.h"

#include <string>
#include <string_view>

namespace diatom {

/// The same bytes for the same cells, however they came about.
Result<std::string> packCells(const CellArray &cells, const Job &job);

/// The inverse. `materials` is the size of the palette; errors are sentences without the file's name.
Result<CellArray> unpackCells(std::string_view bytes, std::size_t materials, CellBudget &budget,
                              const Job &job);

} // namespace diatom
