// The table of checks: what a plugin has to hold, by kind.
#pragma once

#include "plugin_check/findings.h"
#include "plugin_check/subject.h"

#include <string>
#include <vector>

namespace diatom::check {

struct Check
{
   std::string name;                // "lattice.contacts"
   const char *promise;             // what holds where it passes
   const char *interface = nullptr; // run for each thing of it; null = once for the library
   void (*run)(const Subject &subject, Findings &findings) = nullptr;
   int threads = 1; // of the host that it uses
};

inline constexpr const char *kLoads = "module.loads";

/// All of them, in the order in which they are run.
std::vector<Check> allChecks();

// The groups, a file each.
void addModuleChecks(std::vector<Check> &checks);
/// What holds for whatever has no state: lattices, parts and machines.
void addCommonChecks(std::vector<Check> &checks);
void addLatticeChecks(std::vector<Check> &checks);
void addPartsChecks(std::vector<Check> &checks);
void addMachineChecks(std::vector<Check> &checks);
void addSolverChecks(std::vector<Check> &checks);

} // namespace diatom::check
