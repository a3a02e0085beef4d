#include "assembly/chosen_parts.h"

namespace diatom {

Result<std::shared_ptr<const PartMaker>> chosenParts(const Catalogue &catalogue, const AssemblySetup &setup,
                                                     const std::string &asked, const std::string &lattice,
                                                     const Job &job)
{
   const bool own = asked.empty() || asked == setup.parts;
   return PartMaker::make(catalogue, own ? setup.parts : asked, own ? setup.partsValues : Values(), lattice,
                          job);
}

} // namespace diatom
