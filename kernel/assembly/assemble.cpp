#include "assembly/assemble.h"

#include "assembly/chosen_parts.h"
#include "core/file.h"

#include <optional>
#include <utility>

namespace diatom {

Result<Assembled> assemble(const Catalogue &catalogue, const AssemblySetup &setup, const Hierarchy &hierarchy,
                           const std::string &name, const std::filesystem::path &file, const Job &job)
{
   const auto machine = Machine::make(catalogue, setup.machine, setup.machineValues, job);
   if (!machine)
      return machine.error();
   const auto maker = chosenParts(catalogue, setup, "", hierarchy.lattice().spec().id, job);
   if (!maker)
      return maker.error();
   const auto parts = (*maker)->decompose(hierarchy, job);
   if (!parts)
      return parts.error();
   auto plan = planAssembly(hierarchy, *parts, job);
   if (!plan)
      return plan.error();
   std::optional<AtomicFile> out;
   if (!file.empty())
      out.emplace(file);
   const auto sink = [&](std::string_view text) {
      if (out)
         out->write(text);
   };
   auto summary = (*machine)->write(hierarchy, *parts, *plan, name, sink, job);
   if (!summary)
      return summary.error();
   if (out)
      if (const Status status = out->commit(); !status)
         return status.error();
   return Assembled{(*maker)->id(), static_cast<std::int64_t>(parts->parts.size()), *std::move(plan),
                    *std::move(summary)};
}

} // namespace diatom
