#include "cells/runs.h"

#include <algorithm>
#include <vector>

namespace diatom {

void joinRuns(CellArray &cells, const Lattice &lattice)
{
   if (!lattice.hasSupercells())
      return;
   const int length = std::max(1, lattice.supercellDefault());
   const auto stepAt = [&](Index i) { return lattice.supercellStep(lattice.site(i)); };
   std::vector<Index> starts;
   CellArray::Reader reader(cells);
   cells.visit([&](Index i, Cell cell) {
      if (reader.at(i - stepAt(i)).material != cell.material)
         starts.push_back(i);
      return true;
   });
   const CellArray before = cells;
   CellArray::Reader alone(before);
   for (const Index start : starts) {
      Cell cell = alone.at(start);
      const MaterialIndex material = cell.material;
      int place = 0;
      for (Index i = start; cell.material == material;) {
         const Index next = i + stepAt(i);
         const Cell after = alone.at(next);
         const bool last = place + 1 == length || after.material != material;
         cell.joins = static_cast<std::uint8_t>((place > 0 ? Cell::kJoinsPrevious : 0) |
                                                (last ? 0 : Cell::kJoinsNext));
         cells.set(i, cell);
         place = last ? 0 : place + 1;
         i = next;
         cell = after;
      }
   }
}

} // namespace diatom
