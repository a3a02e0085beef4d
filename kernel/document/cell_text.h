// Cells as readable JSON: boxes of one material, and super-cells as runs.
#pragma once

#include "cells/cell_array.h"
#include "cells/model.h"
#include "document/json_place.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <unordered_set>

namespace diatom {

/// [["brass", [x, y, z]], ["brass", [x, y, z], [nx, ny, nz]], {"run": [x, y, z], "step": [0, 1, 0], "length":
/// 4, "material": "brass"}, ...]: the same list for the same cells, however they came about. Expands every
/// cell: for arrays of at most kReadableCells.
nlohmann::ordered_json cellsText(const CellArray &cells, const Model &model);

inline constexpr std::uint64_t kReadableCells = 2'000'000;

/// Counts what cells will cost before they are stored, so that a small file cannot ask for all memory.
class CellBudget
{
public:
   /// False once the boxes given so far touch more bricks than a document may hold.
   bool take(const Box &box);

   static constexpr std::uint64_t kBricks = 131072;         // of 16^3 explicit cells: 2 GiB
   static constexpr double kWhole = 32.0 * double(kBricks); // of one value each

private:
   std::unordered_set<std::uint64_t> m_bricks; // only counted, never walked
   double m_touched = 0;
};

/// Materials by id, made once per document.
using MaterialNames = std::map<std::string, MaterialIndex, std::less<>>;
MaterialNames materialNames(const Model &model);

/// Reads such a list; faults (unknown material, a cell given twice, ...) go to the place's log.
CellArray readCells(const JsonPlace &list, const MaterialNames &materials, CellBudget &budget);

} // namespace diatom
