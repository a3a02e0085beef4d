/* One function for each type of the C contract, so that debug data speaks of all of them: what abidw records
 * and abidiff compares. (On a plugin they see nothing, since its tables are reached through untyped
 * pointers.) */
#include <diatom/abi/core.h>
#include <diatom/abi/lattice.h>
#include <diatom/abi/machine.h>
#include <diatom/abi/parts.h>
#include <diatom/abi/solver.h>

#define ANCHOR(type)                                                                                         \
   const type *anchor_##type(void);                                                                          \
   const type *anchor_##type(void) { return 0; }

ANCHOR(diatom_call)
ANCHOR(diatom_values)
ANCHOR(diatom_create)
ANCHOR(diatom_module)
ANCHOR(diatom_motif)
ANCHOR(diatom_lattice)
ANCHOR(diatom_machine_description)
ANCHOR(diatom_program)
ANCHOR(diatom_text_sink)
ANCHOR(diatom_machine)
ANCHOR(diatom_catalogue)
ANCHOR(diatom_cells)
ANCHOR(diatom_mesh_sink)
ANCHOR(diatom_part_batch)
ANCHOR(diatom_part_sink)
ANCHOR(diatom_parts)
ANCHOR(diatom_channel)
ANCHOR(diatom_scene)
ANCHOR(diatom_capabilities)
ANCHOR(diatom_estimate)
ANCHOR(diatom_step_request)
ANCHOR(diatom_step_result)
ANCHOR(diatom_output)
ANCHOR(diatom_outputs)
ANCHOR(diatom_solver)
ANCHOR(diatom_solver_state)
