// For parts plugins whose parts fill runs of cells: bricks.
#pragma once

#include <diatom/parts.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace diatom::sdk {
inline namespace v1 {

/// Index of a cell as text, for messages.
inline std::string cellName(const diatom_cells &cells, std::int64_t cell)
{
   const std::int32_t *index = cells.index + 3 * cell;
   return std::to_string(index[0]) + " " + std::to_string(index[1]) + " " + std::to_string(index[2]);
}

/// Cells of each run in their order. A run of two materials, or one longer than `longest` (0 = any), is
/// refused.
inline std::vector<std::vector<std::int64_t>> runsOf(const Call &call, const diatom_cells &cells,
                                                     std::size_t longest = 0)
{
   std::vector<std::vector<std::int64_t>> all(static_cast<std::size_t>(cells.count));
   for (std::int64_t i = 0; i < cells.count; ++i) {
      pollEvery(call, i);
      auto &run = all[static_cast<std::size_t>(cells.supercell[i])];
      const auto place = static_cast<std::size_t>(cells.place[i]);
      if (run.size() <= place)
         run.resize(place + 1, -1);
      run[place] = i;
   }
   std::vector<std::vector<std::int64_t>> runs;
   for (auto &run : all) {
      if (run.empty())
         continue;
      const std::int64_t first = run.front();
      for (const std::int64_t cell : run)
         if (cells.material[cell] != cells.material[first])
            throw Failure(DIATOM_BAD_INPUT, "the brick that starts at cell " + cellName(cells, first) +
                                                " has a second material at cell " + cellName(cells, cell) +
                                                "; a brick is made of one");
      if (longest > 0 && run.size() > longest)
         throw Failure(DIATOM_BAD_INPUT, "the brick that starts at cell " + cellName(cells, first) + " is " +
                                             std::to_string(run.size()) + " cells long; at most " +
                                             std::to_string(longest) + " can be made");
      runs.push_back(std::move(run));
   }
   return runs;
}

/// Refuses cells whose layers are not `height` lattice units apart: the parts would not fit together.
inline void needHeight(const diatom_cells &cells, double height, const char *parts)
{
   for (std::int64_t i = 0; i < cells.count; ++i) {
      const double layer = cells.index[3 * i + 2], z = cells.position[3 * i + 2] / cells.pitch;
      if (std::abs(z - layer * height) > 1e-6 * std::abs(layer) * height)
         throw Failure(DIATOM_BAD_INPUT, std::string(parts) + " need cells " +
                                             std::to_string(height).substr(0, 4) +
                                             " of their width high; set the lattice's height to that");
   }
}

/// Bricks of a lattice whose runs go along +y in even layers (site 0) and along +x in odd ones
/// (dmdesign.md 1.3, the deployed rule), each part laid along its run's +x.
inline Wxyz alongRun(std::int32_t site)
{
   return site == 0 ? Wxyz{std::sqrt(0.5), 0, 0, std::sqrt(0.5)} : Wxyz{1, 0, 0, 0};
}

/// Part type 0 once per run, from its first cell along it. A run longer than `longest` (0 = any) is refused.
inline void onePartPerRun(const Call &call, const diatom_cells &cells, PartList &parts,
                          std::size_t longest = 0)
{
   for (const auto &run : runsOf(call, cells, longest))
      parts.add(0, static_cast<std::int32_t>(run.size()), cells.material[run.front()],
                cellPosition(cells, run.front()), alongRun(cells.site[run.front()]), run);
}

} // namespace v1
} // namespace diatom::sdk
