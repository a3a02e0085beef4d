// diatom plan: the order of assembly of a design, and the program that makes a machine build it.
#include "cli/commands.h"

#include "assembly/assemble.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace diatom::cli {

namespace {

struct PlanArguments
{
   std::string file, out, machine, parts;
   std::vector<std::string> settings;
};

/// The document's choices, with what the command line says instead.
Result<AssemblySetup> setupOf(const PlanArguments &arguments, const AssemblySetup &stored,
                              const Catalogue &catalogue)
{
   AssemblySetup setup = stored;
   if (!arguments.parts.empty() && arguments.parts != stored.parts) {
      setup.parts = arguments.parts;
      setup.partsValues.clear();
   }
   const std::string machine =
       arguments.machine.empty() ? stored.machine : fullId(catalogue, DIATOM_MACHINE_1, arguments.machine);
   if (machine != stored.machine) {
      setup.machine = machine;
      setup.machineValues.clear();
   }
   const Result<Values> given = parseValues(arguments.settings);
   if (!given)
      return given.error();
   for (const auto &[name, value] : *given)
      setup.machineValues[name] = value;
   return setup;
}

nlohmann::ordered_json reportOf(const Assembled &planned, const std::string &machine,
                                const PlanArguments &arguments)
{
   auto materials = nlohmann::ordered_json::object();
   for (const auto &[material, count] : planned.summary.byMaterial)
      materials[material] = count;
   auto problems = nlohmann::ordered_json::array();
   for (const std::vector<Problem> *list : {&planned.plan.problems, &planned.summary.problems})
      for (const Problem &problem : *list) {
         nlohmann::ordered_json entry{
             {"severity", problem.severity == Problem::Severity::error ? "error" : "warning"},
             {"kind", problem.kind},
             {"text", problem.text}};
         if (!problem.cells.empty()) {
            const Index first = problem.cells.front();
            entry["cells"] = problem.cells.size();
            entry["first_cell"] = {first.x, first.y, first.z};
         }
         problems.push_back(std::move(entry));
      }
   nlohmann::ordered_json report{{"machine", machine}, {"parts", planned.parts}};
   if (!arguments.out.empty())
      report["file"] = arguments.out;
   report["placements"] = planned.summary.placements;
   report["left_out"] = planned.total - planned.summary.placements;
   report["by_material"] = std::move(materials);
   report["path_m"] = planned.summary.pathMetres;
   report["seconds"] = planned.summary.seconds;
   report["problems"] = std::move(problems);
   return report;
}

void runPlan(const PlanArguments &arguments, Context &context)
{
   const auto input = context.open(arguments.file);
   if (!input)
      return;
   const Design &design = input->opened.design;
   const auto setup = setupOf(arguments, design.assembly, *context.catalogue());
   if (!setup) {
      context.fail(setup.error());
      return;
   }
   const auto planned =
       assemble(*context.catalogue(), *setup, *input->hierarchy, design.name, arguments.out, context.job());
   if (!planned) {
      context.fail(planned.error());
      return;
   }
   if (arguments.out != "-") // standard output is the program itself
      context.print(reportOf(*planned, setup->machine, arguments));
   const std::int64_t left = planned->total - planned->summary.placements;
   if (left > 0) {
      context.note(fmt::format("{} of {} parts cannot be placed; {}", left, planned->total,
                               arguments.out.empty() ? "no program was asked for (-o FILE)"
                                                     : "the program builds the others only"));
      for (const Problem &problem : planned->plan.problems)
         context.note(problem.text);
      context.exit = kCheckFailed;
   }
}

} // namespace

void addPlan(CLI::App &app, Context &context)
{
   auto *command = app.add_subcommand("plan", "Plan the assembly and write a machine's program");
   const auto arguments = std::make_shared<PlanArguments>();
   command->add_option("FILE", arguments->file, "Design; - reads standard input")->required();
   command->add_option("--machine", arguments->machine,
                       "Machine: an id, or its last word (see diatom machines)");
   command->add_option("-o,--output", arguments->out,
                       "Program to write; - writes standard output; without it the plan is only reported");
   command->add_option("--parts", arguments->parts, "What turns cells into parts (see diatom parts)");
   command->add_option("--set", arguments->settings, "Machine setting NAME=VALUE, in SI units; repeats");
   command->footer("Exit 5: some parts cannot be placed; the program builds the others.\n"
                   "Example: diatom plan tower.diatom --machine gcode --set feed=0.01 -o tower.ngc");
   command->callback([arguments, &context] { runPlan(*arguments, context); });
}

} // namespace diatom::cli
