// One check at a time, each in a process of its own or, for a debugger, in this one.
#pragma once

#include "core/sanitizers.h"
#include "plugin_check/checks.h"

#include <filesystem>
#include <string>
#include <vector>

namespace diatom::check {

struct Outcome
{
   const Check *check = nullptr;
   std::vector<Finding> findings;
   double seconds = 0;
};

/// What the process of a check needs to be started again the same.
struct Request
{
   std::filesystem::path folder;
   std::uint64_t seed = 0;
   std::vector<std::filesystem::path> designs;
   double seconds = 60 * kSlowdown; // then it counts as hanging
};

/// In this process: runs the check on each of the plugin's things that it is for, and looks at what the
/// process is like afterwards.
std::vector<Finding> runHere(const Check &check, Subject subject);

/// In a process of its own, whose crash or hang is a finding.
Outcome runApart(const Check &check, const Request &request);

/// The other end of runApart(): hands over what was found.
void handOver(const std::vector<Finding> &findings);

} // namespace diatom::check
