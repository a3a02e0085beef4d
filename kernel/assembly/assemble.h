// From a design to the program that makes a machine build it: parts, order, text, in one go.
#pragma once

#include "assembly/plan.h"

#include <filesystem>
#include <string>

namespace diatom {

struct Assembled
{
   std::string parts;      // id of the decomposition
   std::int64_t total = 0; // parts of the design; what the summary does not place is in the plan's problems
   AssemblyPlan plan;
   ProgramSummary summary;
};

/// Plans the assembly of the design as `setup` says and writes the program atomically; "-" is standard
/// output, an empty file plans only. `name` is the design's, for the program's heading.
Result<Assembled> assemble(const Catalogue &catalogue, const AssemblySetup &setup, const Hierarchy &hierarchy,
                           const std::string &name, const std::filesystem::path &file, const Job &job);

} // namespace diatom
