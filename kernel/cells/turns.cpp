#include "cells/turns.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

std::size_t fewestRotations(const Lattice &lattice)
{
   std::size_t fewest = lattice.shape(0).rotations.size();
   for (int site = 1; site < lattice.sites(); ++site)
      fewest = std::min(fewest, lattice.shape(site).rotations.size());
   return fewest;
}

Status checkBody(const std::string &where, const Body &body, const Lattice &lattice, std::size_t orientations)
{
   Status status;
   body.cells.visitBlocks(body.cells.bounds(), [&](const Box &box, Cell cell) {
      if (!cell.empty() && cell.orientation >= orientations)
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
   const std::size_t orientations = fewestRotations(lattice);
   for (const auto &[id, definition] : model.definitions)
      if (Status fits = checkBody(definition->id, definition->body, lattice, orientations); !fits)
         return fits;
   return checkBody("assembly", model.root, lattice, orientations);
}

} // namespace diatom
