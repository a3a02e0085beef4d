// One thing of each kind that keeps the contract, but for the rule that DIATOM_TEST_FAULT names: so each
// check of diatom-plugin-check is seen to fail, and to pass where nothing is broken.
#include "lattice.h"
#include "machine.h"
#include "parts.h"
#include "solver.h"

namespace {

[[gnu::constructor]] void load()
{
   if (unruly::breaks("module.loads"))
      unruly::oversleep(150);
}

const void *get(const char *interface)
{
   const std::string_view id(interface);
   if (id == DIATOM_LATTICE_1 || unruly::breaks("module.interfaces"))
      return &unruly::kLattice;
   if (id == DIATOM_PARTS_1)
      return &unruly::kParts;
   if (id == DIATOM_SOLVER_1)
      return &unruly::kSolver;
   if (id == DIATOM_SOLVER_STATE_1)
      return &unruly::kState;
   return diatom::sdk::detail::MachineTable<unruly::Mover>::get(interface);
}

} // namespace

DIATOM_MODULE(get)
