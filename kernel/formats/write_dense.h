// Dense arrays [x][y][z] with the index of their first element, as both earlier programs write cells.
#pragma once

#include "core/index.h"
#include "core/result.h"

#include <nlohmann/json.hpp>

namespace diatom {

class DenseCells
{
public:
   /// Refuses boxes with more places than such a file should spell out.
   static Status check(const Box &bounds);
   /// Empty bounds give the programs' empty assembly.
   explicit DenseCells(const Box &bounds);

   nlohmann::ordered_json &at(Index i);
   /// Adds "cellsMin", "cellsMax" and "sparseCells".
   void put(nlohmann::ordered_json &to) &&;

private:
   Box m_bounds;
   nlohmann::ordered_json m_cells;
};

nlohmann::ordered_json xyz(Index i);

} // namespace diatom
