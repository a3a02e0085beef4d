// Order of assembly: which part goes when, so that each can be supported and reached from above; then the
// machine-neutral program and, through a machine plugin, its text.
#pragma once

#include "core/job.h"
#include "parts/decomposition.h"
#include "plugins/catalogue.h"
#include "scene/networks.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// Choices a document stores for making the assembly.
struct AssemblySetup
{
   std::string parts; // id of the decomposition; empty = the first that fits the lattice
   Values partsValues;
   std::string machine = "org.diatom_cad.machine.gcode";
   Values machineValues;
   friend bool operator==(const AssemblySetup &, const AssemblySetup &) = default;
};

struct AssemblyPlan
{
   std::vector<std::int64_t> order; // parts of the decomposition, in placing order
   std::vector<Problem> problems;   // parts that cannot be supported or reached; these are not in `order`
};

/// Layer by layer from the build plate: a part is placed only when the plate or a part already placed holds
/// it through a joined contact, and nothing already placed is in the way from above. Order depends on content
/// only.
Result<AssemblyPlan> planAssembly(const Hierarchy &hierarchy, const Decomposition &parts, const Job &job);

struct ProgramSummary
{
   std::int64_t placements = 0;
   std::vector<std::pair<std::string, std::int64_t>> byMaterial;
   double pathMetres = 0;
   double seconds = 0;
   std::vector<Problem> problems; // outside the work volume, more materials than feeders, ...
};

/// A machine plugin's instance. Any thread.
class Machine
{
public:
   static Result<std::shared_ptr<const Machine>> make(const Catalogue &catalogue, const std::string &id,
                                                      const Values &values, const Job &job);
   const diatom_machine_description &description() const;
   /// Pick-and-place program of the plan, as text in pieces.
   Result<ProgramSummary> write(const Hierarchy &hierarchy, const Decomposition &parts,
                                const AssemblyPlan &plan, const std::string &name,
                                const std::function<void(std::string_view)> &sink, const Job &job) const;
   ~Machine();

private:
   Machine();
   struct Self;
   std::unique_ptr<Self> m_self;
};

} // namespace diatom
