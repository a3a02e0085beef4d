#include "cells/turns.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

/// Rotations that every cell of the box has; sites may have different shapes.
std::size_t rotationsWithin(const Lattice &lattice, const Box &box)
{
   const auto period = lattice.period();
   const auto last = [](std::int32_t min, std::int32_t max, int steps) {
      return max - min < steps ? max : min + steps - 1;
   };
   std::size_t fewest = lattice.shape(lattice.site(box.min)).rotations.size();
   for (std::int32_t x = box.min.x; x <= last(box.min.x, box.max.x, period[0]); ++x)
      for (std::int32_t y = box.min.y; y <= last(box.min.y, box.max.y, period[1]); ++y)
         for (std::int32_t z = box.min.z; z <= last(box.min.z, box.max.z, period[2]); ++z)
            fewest = std::min(fewest, lattice.shape(lattice.site({x, y, z})).rotations.size());
   return fewest;
}

Status checkBody(const std::string &where, const Body &body, const Lattice &lattice)
{
   Status status;
   body.cells.visitBlocks(body.cells.bounds(), [&](const Box &box, Cell cell) {
      if (cell.empty() || cell.orientation == 0)
         return true;
      const auto orientations = rotationsWithin(lattice, box);
      if (cell.orientation >= orientations)
         status =
             Error{ErrorCode::invalid,
                   fmt::format("{}: the cell at {} {} {} has orientation {}, its shape has 0 to {}; turn it "
                               "or choose another lattice",
                               where, box.min.x, box.min.y, box.min.z, cell.orientation, orientations - 1)};
      return status.ok();
   });
   if (!status)
      return status;
   body.instances.visit([&](const Placement &placement) {
      if (placement.rotation >= lattice.rotations().size())
         status = Error{
             ErrorCode::invalid,
             fmt::format("{}: the composite at {} {} {} has rotation {}, the lattice has 0 to {}; turn it "
                         "or choose another lattice",
                         where, placement.origin.x, placement.origin.y, placement.origin.z,
                         placement.rotation, lattice.rotations().size() - 1)};
      return status.ok();
   });
   return status;
}

} // namespace

Status checkTurns(const Model &model, const Lattice &lattice)
{
   for (const auto &[id, definition] : model.definitions)
      if (Status fits = checkBody(definition->id, definition->body, lattice); !fits)
         return fits;
   return checkBody("assembly", model.root, lattice);
}

} // namespace diatom
