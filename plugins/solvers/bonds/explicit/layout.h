// In which order the vector kernel takes cells and bonds: tiles that fit the cache, cells in them plane by
// plane, bonds of sixteen neighbouring cells at once.
#pragma once

#include "explicit/sweep.h"
#include "model/assembly.h"

namespace bonds {

struct Layout
{
   /// `actuated` says of each bond whether its rest shape may change; empty where none does. `still` says of
   /// each cell whether nothing ever moves it: bonds between two such cells are left out, since they move
   /// nothing. `lanes` of a vector: those of the longest, whatever a machine has, so that all add up alike.
   Layout(const Assembly &assembly, const std::vector<bool> &actuated, const std::vector<bool> &still,
          std::uint32_t lanes);

   std::size_t places = 0;           // of cells, with padding
   std::vector<std::uint32_t> place; // of each cell
   std::vector<std::int32_t> cell;   // at each place, -1 where there is none

   std::vector<Tile> tiles;
   std::vector<Chunk> chunks; // and one past the last
   std::vector<Run> runs;     // of chunks, then from `firstCross` on those between tiles
   std::vector<Crossing> crossings;
   std::vector<std::uint32_t> listLo, listHi;
   std::uint32_t firstCross = 0, span = 0;

   int constants = 0;        // of a bond that are stored
   std::vector<double> pool; // constants of the runs
   std::vector<double> frames;
   std::size_t restPlaces = 0;
   /// Where an actuated bond's rest shape goes, six numbers kBlock apart; `reversed` bonds run from b to a.
   struct RestPlace
   {
      std::int64_t bond = 0;
      std::size_t at = 0;
      bool reversed = false;
   };
   std::vector<RestPlace> rests;
};

} // namespace bonds
