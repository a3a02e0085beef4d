// Commands on single cells and super-cells: place, erase, paint.
#include "document/command_edit.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

std::string compositeName(const Model &model, const Found &found)
{
   const auto *definition = model.definition(found.path.front().definition);
   return definition ? definition->id : "?";
}

/// Cells of a new super-cell at `start`, or the one cell.
std::vector<Index> runFrom(const Lattice &lattice, Index start, std::int64_t length)
{
   std::vector<Index> run{start};
   for (std::int64_t k = 1; k < length && inRange(run.back()); ++k)
      run.push_back(run.back() + lattice.supercellStep(lattice.site(run.back())));
   return run;
}

std::int64_t readLength(Edit &edit, const Lattice &lattice)
{
   constexpr std::int64_t kLongest = 10'000;
   if (!edit.arguments().has("length"))
      return lattice.hasSupercells() ? lattice.supercellDefault() : 1;
   const auto most = !lattice.hasSupercells()         ? 1
                     : lattice.supercellLongest() > 0 ? lattice.supercellLongest()
                                                      : kLongest;
   return edit.arguments().at("length").integer(1, most);
}

void placeRun(Edit &edit, const std::vector<Index> &run, MaterialIndex material, std::uint8_t orientation)
{
   auto &cells = edit.model().root.cells;
   for (std::size_t k = 0; k < run.size() && edit.ok(); ++k) {
      const Index i = run[k];
      if (!inRange(i)) {
         edit.fail(ErrorCode::invalid,
                   fmt::format("{} is outside the index range; place it nearer to the origin", cellText(i)));
      } else if (const auto found = edit.hierarchy()->find(i); found && !found->path.empty()) {
         edit.fail(ErrorCode::invalid, fmt::format("{} is taken by composite \"{}\"; erase that first",
                                                   cellText(i), compositeName(edit.model(), *found)));
      } else if (!cells.at(i).empty()) {
         edit.fail(ErrorCode::invalid,
                   fmt::format("{} is taken; erase or paint that cell instead", cellText(i)));
      } else {
         const auto joins = (k > 0 ? Cell::kJoinsPrevious : 0) | (k + 1 < run.size() ? Cell::kJoinsNext : 0);
         cells.set(i, {material, orientation, static_cast<std::uint8_t>(joins)});
      }
   }
}

Result<std::string> place(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "place", arguments);
   const auto material = edit.material("material");
   const auto cells = edit.cells();
   if (const auto *hierarchy = edit.hierarchy()) {
      const auto length = readLength(edit, hierarchy->lattice());
      for (const Index cell : cells)
         if (edit.ok())
            placeRun(edit, runFrom(hierarchy->lattice(), cell, length), material, edit.orientation(cell));
   }
   return edit.commit(cells.size() == 1 ? "place" : countText("place", cells.size()));
}

/// Erases what the cell belongs to: its super-cell, or the outermost composite. Cells that an earlier index
/// of the same command took along are passed over.
void eraseOne(Edit &edit, Index cell)
{
   const auto found = edit.hierarchy()->find(cell);
   auto &root = edit.model().root;
   if (!found)
      edit.fail(ErrorCode::invalid, fmt::format("there is no cell at {}", cellText(cell)));
   else if (!found->path.empty())
      root.instances.erase(found->path.front());
   else
      for (const Index i : edit.hierarchy()->supercell(cell))
         root.cells.set(i, {});
}

Result<std::string> erase(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "erase", arguments);
   const auto cells = edit.cells();
   for (const Index cell : cells)
      if (edit.ok() && edit.hierarchy())
         eraseOne(edit, cell);
   edit.pruneSetup();
   return edit.commit(countText("erase", cells.size()));
}

void paintOne(Edit &edit, Index cell, MaterialIndex material, bool turn)
{
   const auto found = edit.hierarchy()->find(cell);
   if (!found) {
      edit.fail(ErrorCode::invalid, fmt::format("there is no cell at {}", cellText(cell)));
      return;
   }
   if (!found->path.empty()) {
      edit.fail(ErrorCode::invalid,
                fmt::format("{} belongs to composite \"{}\"; dissolve it or paint its definition",
                            cellText(cell), compositeName(edit.model(), *found)));
      return;
   }
   auto &cells = edit.model().root.cells;
   for (const Index i : edit.hierarchy()->supercell(cell)) {
      Cell painted = cells.at(i);
      painted.material = material;
      if (turn)
         painted.orientation = edit.orientation(i);
      cells.set(i, painted);
   }
}

Result<std::string> paint(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "paint", arguments);
   const auto material = edit.material("material");
   const auto cells = edit.cells();
   const bool turn = edit.arguments().has("orientation");
   for (const Index cell : cells)
      if (edit.ok() && edit.hierarchy())
         paintOne(edit, cell, material, turn);
   return edit.commit(countText("paint", cells.size()));
}

constexpr CommandParameter kPlace[] = {
    {"cell", "index", false, "where; or `cells`"},
    {"cells", "cells", false, "several places at once"},
    {"material", "material", true, "id of the material"},
    {"orientation", "number", false, "rotation number of the cell's shape"},
    {"length", "number", false,
     "cells in a super-cell, where the lattice has them; default the lattice's own"},
};
constexpr CommandParameter kErase[] = {
    {"cell", "index", false, "any cell of what to erase; or `cells`"},
    {"cells", "cells", false, "several at once"},
};
constexpr CommandParameter kPaint[] = {
    {"cell", "index", false, "any cell of a super-cell; or `cells`"},
    {"cells", "cells", false, "several at once"},
    {"material", "material", true, "id of the new material"},
    {"orientation", "number", false, "new rotation number; default as it was"},
};

constexpr Command kCellTable[] = {
    {"place", "Place cell", "Puts a cell or super-cell where nothing is.", kPlace, place},
    {"erase", "Erase cell", "Removes a cell with its super-cell, or the composite it belongs to.", kErase,
     erase},
    {"paint", "Paint cell", "Changes the material of a cell and its super-cell.", kPaint, paint},
};

} // namespace

const std::span<const Command> kCellCommands = kCellTable;

} // namespace diatom
