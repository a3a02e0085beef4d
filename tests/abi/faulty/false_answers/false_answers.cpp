// One module with a lattice, parts, a machine and a solver, each of which answers falsely as its parameter
// says.
#include "lattice.h"
#include "machine.h"
#include "parts.h"
#include "solver.h"

namespace {

const void *get(const char *interface)
{
   static constexpr diatom_lattice lattice = false_answers::FalseLattice::table();
   if (std::string_view(interface) == DIATOM_LATTICE_1)
      return &lattice;
   if (const void *table = diatom::sdk::parts_detail::get<false_answers::falseParts>(interface))
      return table;
   if (const void *table = diatom::sdk::detail::MachineTable<false_answers::FalseMachine>::get(interface))
      return table;
   return diatom::sdk::SolverTable<false_answers::FalseSolver>::get(interface);
}

} // namespace

DIATOM_MODULE(get)
