#include "document/missing_lattice.h"

#include <fmt/format.h>

namespace diatom {

std::string missingLattice(const Design &design, const Catalogue &catalogue)
{
   const std::string &lattice = design.model.lattice.id;
   if (catalogue.offer(DIATOM_LATTICE_1, lattice))
      return {};
   return fmt::format(
       "The lattice {} is not installed: the {} stored cells cannot be shown, and are kept and "
       "saved unchanged. `diatom plugins` lists what there is.",
       lattice, storedCells(design.model));
}

std::uint64_t storedCells(const Model &model)
{
   std::uint64_t cells = model.root.cells.count();
   for (const auto &[id, definition] : model.definitions)
      cells += definition->body.cells.count();
   return cells;
}

} // namespace diatom
