// The plugin: steady heat conduction, see conduction.hpp.
#include "conduction.hpp"

DIATOM_SOLVER(conduction::Conduction)
