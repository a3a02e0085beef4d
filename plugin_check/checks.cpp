#include "plugin_check/checks.h"

namespace diatom::check {

std::vector<Check> allChecks()
{
   std::vector<Check> checks;
   for (const auto add : {addModuleChecks, addCommonChecks, addLatticeChecks, addPartsChecks,
                          addMachineChecks, addSolverChecks})
      add(checks);
   return checks;
}

} // namespace diatom::check
