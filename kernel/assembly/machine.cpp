// A machine plugin's instance: its description, checked once, and programs written through it.
#include "assembly/plan.h"

#include "assembly/motion.h"
#include "assembly/program.h"

#include <fmt/format.h>

#include <map>

namespace diatom {

struct Machine::Self
{
   std::shared_ptr<const Instance> instance;
   const diatom_machine_description *description = nullptr; // the plugin's, as long as the instance lives
};

namespace {

/// What the text sink of the C table needs to know.
struct SinkHost
{
   const std::function<void(std::string_view)> &sink;
   const Job &job;
};

std::int32_t takeText(const diatom_text_sink *sink, const char *bytes, std::int64_t count)
{
   const auto *host = static_cast<const SinkHost *>(sink->host);
   if (count < 0 || (count > 0 && !bytes))
      return DIATOM_BAD_INPUT;
   if (host->job.cancelled())
      return DIATOM_CANCELLED;
   host->sink({bytes, static_cast<std::size_t>(count)});
   return DIATOM_OK;
}

std::vector<std::pair<std::string, std::int64_t>>
countMaterials(const Model &model, const Decomposition &parts, const AssemblyPlan &plan)
{
   std::map<MaterialIndex, std::int64_t> counts;
   for (const std::int64_t part : plan.order)
      ++counts[parts.parts[static_cast<std::size_t>(part)].material];
   std::vector<std::pair<std::string, std::int64_t>> result;
   for (const auto &[material, count] : counts)
      result.emplace_back(model.material(material).id, count);
   return result;
}

std::vector<Problem> refills(const Layout &layout, const diatom_machine_description &machine)
{
   std::vector<Problem> problems;
   for (std::size_t f = 0; f < layout.stocks.size(); ++f) {
      const std::int64_t places = std::int64_t{machine.feeder_columns[f]} * machine.feeder_rows[f];
      const std::int64_t times = (layout.stocks[f].parts - 1) / places;
      if (places > 1 && times > 0)
         problems.push_back(
             {Problem::Severity::warning,
              "feeder-refill",
              fmt::format("feeder {} holds {} parts of {} and must be refilled {} times: the program "
                          "stops for it; larger feeders need fewer stops",
                          f + 1, places, layout.stocks[f].label, times),
              {}});
   }
   return problems;
}

} // namespace

Machine::Machine() : m_self(std::make_unique<Self>()) {}
Machine::~Machine() = default;

Result<std::shared_ptr<const Machine>> Machine::make(const Catalogue &catalogue, const std::string &id,
                                                     const Values &values, const Job &job)
{
   auto instance = catalogue.create<diatom_machine>(DIATOM_MACHINE_1, id, values, job);
   if (!instance)
      return instance.error();
   const std::shared_ptr<Machine> machine(new Machine);
   machine->m_self->instance = *instance;
   const Instance &made = **instance;
   const Status status = made.call("describe", job, [&](const diatom_call *call) {
      return made.table<diatom_machine>()->describe(made.self(), call, &machine->m_self->description);
   });
   if (!status)
      return status.error();
   const std::string fault = machine->m_self->description ? checkDescription(*machine->m_self->description)
                                                          : "it describes nothing";
   if (!fault.empty())
      return Error{ErrorCode::unsupported, fmt::format("the machine {} cannot be used: {}", id, fault)};
   return std::shared_ptr<const Machine>(machine);
}

const diatom_machine_description &Machine::description() const { return *m_self->description; }

Result<ProgramSummary> Machine::write(const Hierarchy &hierarchy, const Decomposition &parts,
                                      const AssemblyPlan &plan, const std::string &name,
                                      const std::function<void(std::string_view)> &sink, const Job &job) const
{
   const Result<Layout> layout = layOut(hierarchy, parts, plan, description());
   if (!layout)
      return layout.error();
   SinkHost host{sink, job};
   const diatom_text_sink text{sizeof text, &host, takeText};
   const Instance &instance = *m_self->instance;
   const PieceSink post = [&](const diatom_program &program) {
      return instance.call("post", job, [&](const diatom_call *call) {
         return instance.table<diatom_machine>()->post(instance.self(), call, &program, &text);
      });
   };
   const Result<ProgramLength> length = writeProgram(*layout, description(), name, post, job);
   if (!length)
      return length.error();
   ProgramSummary summary;
   summary.placements = static_cast<std::int64_t>(plan.order.size());
   summary.byMaterial = countMaterials(hierarchy.model(), parts, plan);
   summary.pathMetres = length->pathMetres;
   summary.seconds = length->seconds;
   summary.problems = refills(*layout, description());
   return summary;
}

} // namespace diatom
