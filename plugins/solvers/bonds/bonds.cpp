// The module's one exported symbol.
#include "bonds_solver.h"

DIATOM_SOLVER(bonds::BondsSolver)
