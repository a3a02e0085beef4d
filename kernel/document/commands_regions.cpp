// Commands on boxes of cells: fill, erase, clone, move, array.
#include "document/cell_text.h"
#include "document/command_edit.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

constexpr double kMostBricksFilled = 2'000'000; // cells, where each must be joined into a super-cell

/// Content of a region: own cells, each super-cell whole, and the instances that lie in it.
struct Region
{
   std::vector<std::pair<Index, Cell>> cells;
   std::vector<Placement> instances;
};

Box instanceBounds(Edit &edit, const Placement &placement)
{
   Model one = edit.design().model;
   one.root = {};
   one.root.instances.insert(placement);
   const auto *before = edit.hierarchy();
   const std::shared_ptr<const Lattice> lattice(std::shared_ptr<void>(), &before->lattice());
   return Hierarchy(lattice, std::move(one), before).bounds();
}

bool inside(const Box &inner, const Box &outer)
{
   return outer.contains(inner.min) && outer.contains(inner.max);
}

Region regionOf(Edit &edit, const Box &box)
{
   Region region;
   const auto *before = edit.hierarchy();
   edit.model().root.cells.visit(box, [&](Index i, Cell cell) {
      region.cells.emplace_back(i, cell);
      if (cell.joins != 0)
         for (const Index j : before->supercell(i))
            if (!box.contains(j))
               edit.fail(ErrorCode::invalid,
                         fmt::format("the box cuts the super-cell at {}; make it larger", cellText(i)));
      return edit.ok() && !edit.job().cancelled();
   });
   edit.model().root.instances.visit([&](const Placement &placement) {
      const Box bounds = instanceBounds(edit, placement);
      if (inside(bounds, box))
         region.instances.push_back(placement);
      else if (bounds.intersects(box))
         edit.fail(ErrorCode::invalid, fmt::format("the box cuts the composite at {}; make it larger",
                                                   cellText(placement.origin)));
      return edit.ok();
   });
   if (edit.ok() && region.cells.empty() && region.instances.empty())
      edit.fail(ErrorCode::invalid, "there is nothing in the box");
   return region;
}

void removeRegion(Edit &edit, const Region &region)
{
   auto &root = edit.model().root;
   for (const auto &[index, cell] : region.cells)
      root.cells.set(index, {});
   for (const auto &placement : region.instances)
      root.instances.erase(placement);
}

/// Puts the region down again, moved by `by`. What is there already is a fault.
void putRegion(Edit &edit, const Region &region, Index by)
{
   const auto present = edit.now();
   if (!present)
      return;
   auto &root = edit.model().root;
   for (const auto &[index, cell] : region.cells) {
      const Index to = index + by;
      if (!inRange(to) || !present->at(to).empty()) {
         edit.fail(ErrorCode::invalid, fmt::format("{} is {}; choose another place", cellText(to),
                                                   inRange(to) ? "taken" : "outside the index range"));
         return;
      }
      root.cells.set(to, cell);
   }
   for (auto placement : region.instances) {
      const Box bounds = instanceBounds(edit, placement);
      placement.origin = placement.origin + by;
      const Box there{bounds.min + by, bounds.max + by};
      if (!inRange(there.min) || !inRange(there.max)) {
         edit.fail(ErrorCode::invalid, "a composite would lie outside the index range; choose another place");
         return;
      }
      Index hit;
      const auto stop = [&hit](Index i, Cell) {
         hit = i;
         return false;
      };
      if (!present->visit(there, stop)) {
         edit.fail(ErrorCode::invalid, fmt::format("{} is taken; choose another place", cellText(hit)));
         return;
      }
      root.instances.insert(placement);
   }
}

/// A shift keeps every contact when it is a whole number of the lattice's periods.
void checkShift(Edit &edit, Index by)
{
   const auto period = edit.hierarchy()->lattice().period();
   const bool whole =
       floorMod(by.x, period[0]) == 0 && floorMod(by.y, period[1]) == 0 && floorMod(by.z, period[2]) == 0;
   if (!whole)
      edit.fail(ErrorCode::invalid,
                fmt::format("this lattice repeats every [{}, {}, {}] cells; move by a multiple of that",
                            period[0], period[1], period[2]));
   const auto near = [](std::int32_t v) { return v >= -kIndexLimit && v <= kIndexLimit; };
   if (!near(by.x) || !near(by.y) || !near(by.z))
      edit.fail(ErrorCode::invalid, "the distance is outside the index range");
}

Result<std::string> copyTo(CommandContext &context, const nlohmann::json &arguments, bool move)
{
   const char *name = move ? "move" : "clone";
   Edit edit(context, name, arguments);
   const Box box = edit.box();
   const Index to = edit.arguments().at("to").index();
   if (edit.ok() && edit.hierarchy()) {
      const Index by = to - box.min;
      checkShift(edit, by);
      const auto region = regionOf(edit, box);
      if (move && edit.ok())
         removeRegion(edit, region);
      if (edit.ok())
         putRegion(edit, region, by);
   }
   if (move)
      edit.pruneSetup();
   return edit.commit(edit.ok() ? fmt::format("{} {}", name, sizeText(box)) : name);
}

Result<std::string> cloneBox(CommandContext &context, const nlohmann::json &arguments)
{
   return copyTo(context, arguments, false);
}

Result<std::string> moveBox(CommandContext &context, const nlohmann::json &arguments)
{
   return copyTo(context, arguments, true);
}

Result<std::string> arrayBox(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "array", arguments);
   const Box box = edit.box();
   const Index step = edit.arguments().at("step").index();
   const auto count = edit.arguments().at("count").integer(2, 10'000);
   if (edit.ok() && edit.hierarchy()) {
      checkShift(edit, step);
      const auto region = regionOf(edit, box);
      for (std::int64_t copy = 1; copy < count && edit.ok() && !edit.job().cancelled(); ++copy) {
         const auto scaled = [copy](std::int32_t v) {
            return std::clamp<std::int64_t>(v * copy, -kIndexLimit, kIndexLimit);
         };
         putRegion(edit, region,
                   {static_cast<std::int32_t>(scaled(step.x)), static_cast<std::int32_t>(scaled(step.y)),
                    static_cast<std::int32_t>(scaled(step.z))});
      }
   }
   return edit.commit(fmt::format("array of {}", count));
}

/// Fills with super-cells of the lattice's usual length, shorter ones at the end of each row.
void fillSupercells(Edit &edit, const Box &box, Cell cell)
{
   const auto &lattice = edit.hierarchy()->lattice();
   if (box.volume() > kMostBricksFilled) {
      edit.fail(ErrorCode::invalid,
                fmt::format("a box of more than {:.0f} cells cannot be filled with super-cells at once; fill "
                            "a smaller one and use composites",
                            kMostBricksFilled));
      return;
   }
   auto &cells = edit.model().root.cells;
   const auto stepAt = [&lattice](Index i) { return lattice.supercellStep(lattice.site(i)); };
   for (std::int32_t z = box.min.z; z <= box.max.z; ++z)
      for (std::int32_t y = box.min.y; y <= box.max.y; ++y)
         for (std::int32_t x = box.min.x; x <= box.max.x; ++x) {
            const Index start{x, y, z};
            if (box.contains(start - stepAt(start)))
               continue; // within a row that began earlier
            std::vector<Index> row;
            for (Index i = start; box.contains(i); i = i + stepAt(i))
               row.push_back(i);
            const auto length = static_cast<std::size_t>(std::max(1, lattice.supercellDefault()));
            for (std::size_t k = 0; k < row.size(); ++k) {
               const bool first = k % length == 0, last = k % length == length - 1 || k + 1 == row.size();
               cell.joins = static_cast<std::uint8_t>((first ? 0 : Cell::kJoinsPrevious) |
                                                      (last ? 0 : Cell::kJoinsNext));
               cells.set(row[k], cell);
            }
         }
}

/// Faults of a fill: cells of composites in the box, super-cells cut by it, more memory than a document may
/// hold.
void checkFill(Edit &edit, const Box &box)
{
   CellBudget budget;
   if (!budget.take(box)) {
      edit.fail(ErrorCode::invalid,
                fmt::format("a box of {} is more than a document may hold at once; build it of composites",
                            sizeText(box)));
      return;
   }
   const auto *before = edit.hierarchy();
   const auto &cells = edit.model().root.cells;
   if (edit.model().root.instances.count() > 0)
      before->visit(box, [&](Index i, Cell) {
         if (cells.at(i).empty())
            edit.fail(
                ErrorCode::invalid,
                fmt::format("{} belongs to a composite; fill around it or erase it first", cellText(i)));
         return edit.ok();
      });
   if (!before->lattice().hasSupercells())
      return;
   cells.visit(box, [&](Index i, Cell cell) {
      if (cell.joins != 0)
         for (const Index j : before->supercell(i))
            if (!box.contains(j))
               edit.fail(ErrorCode::invalid,
                         fmt::format("the box cuts the super-cell at {}; make it larger", cellText(i)));
      return edit.ok();
   });
}

Result<std::string> fill(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "fill", arguments);
   const auto material = edit.material("material");
   const Box box = edit.box();
   if (edit.ok() && edit.hierarchy())
      checkFill(edit, box);
   if (edit.ok()) {
      const Cell cell{material, edit.orientation(box.min), 0};
      if (edit.hierarchy()->lattice().hasSupercells())
         fillSupercells(edit, box, cell);
      else
         edit.model().root.cells.fill(box, cell);
   }
   return edit.commit(edit.ok() ? fmt::format("fill {}", sizeText(box)) : "fill");
}

Result<std::string> eraseBox(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "erase-box", arguments);
   const Box box = edit.box();
   const auto *before = edit.ok() ? edit.hierarchy() : nullptr;
   if (before) {
      auto &root = edit.model().root;
      if (before->lattice().hasSupercells()) {
         const CellArray cells = root.cells;
         cells.visit(box, [&](Index i, Cell) {
            for (const Index j : before->supercell(i))
               root.cells.set(j, {});
            return true;
         });
      } else {
         // What is there is less than the box: never make bricks only to empty them.
         Box used = root.cells.bounds();
         used = {{std::max(used.min.x, box.min.x), std::max(used.min.y, box.min.y),
                  std::max(used.min.z, box.min.z)},
                 {std::min(used.max.x, box.max.x), std::min(used.max.y, box.max.y),
                  std::min(used.max.z, box.max.z)}};
         if (!used.empty())
            root.cells.fill(used, {});
      }
      std::vector<Placement> touched;
      root.instances.visit([&](const Placement &placement) {
         if (instanceBounds(edit, placement).intersects(box))
            touched.push_back(placement);
         return true;
      });
      for (const auto &placement : touched)
         root.instances.erase(placement);
      if (root == context.design.model.root)
         edit.fail(ErrorCode::invalid, "there is nothing in the box");
   }
   edit.pruneSetup();
   return edit.commit(edit.ok() ? fmt::format("erase {}", sizeText(box)) : "erase");
}

constexpr CommandParameter kFill[] = {
    {"box", "box", true, "two opposite corners"},
    {"material", "material", true, "id of the material"},
    {"orientation", "number", false, "rotation number of the cells' shape"},
};
constexpr CommandParameter kBox[] = {{"box", "box", true, "two opposite corners"}};
constexpr CommandParameter kTo[] = {
    {"box", "box", true, "two opposite corners"},
    {"to", "index", true, "where the box's lowest corner goes"},
};
constexpr CommandParameter kArray[] = {
    {"box", "box", true, "two opposite corners"},
    {"step", "index", true, "from one copy to the next"},
    {"count", "number", true, "how many in all, the original included"},
};

constexpr Command kRegionTable[] = {
    {"fill", "Fill box", "Fills a box with a material, replacing cells that are there.", kFill, fill},
    {"erase-box", "Erase box", "Removes every cell, super-cell and composite that a box touches.", kBox,
     eraseBox},
    {"clone", "Clone box", "Copies what is in a box to another place.", kTo, cloneBox},
    {"move", "Move box", "Moves what is in a box to another place.", kTo, moveBox},
    {"array", "Array", "Repeats what is in a box along a step.", kArray, arrayBox},
};

} // namespace

const std::span<const Command> kRegionCommands = kRegionTable;

} // namespace diatom
