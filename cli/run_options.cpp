#include "cli/run_options.h"

#include "cli/scene_json.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace diatom::cli {

namespace {

Status apply(const RunOptions &options, Design &design)
{
   for (const std::string &setting : options.settings)
      if (Status set = applySetting(setting, design); !set)
         return set;
   Setup &setup = design.setup;
   for (const auto &[name, value] :
        {std::pair{"beam", &options.beam}, std::pair{"gradient", &options.gradient}})
      if (!value->empty())
         setup.solverValues[name] = *value;
   return options.effects.empty() ? Status() : applyEffects(options.effects, setup);
}

} // namespace

void addModelOptions(CLI::App &command, RunOptions &options)
{
   command.add_option("FILE", options.file, "A design of any readable format, - for standard input")
       ->required();
   command.add_option("--solver", options.solver, "Solver: an id, or its last word (see diatom solvers)");
   command.add_option("--beam", options.beam, "Beam theory of a bond: timoshenko, thesis, euler");
   command.add_option("--gradient", options.gradient, "Torques: exact or simple");
   command.add_option("--effects", options.effects, "auto, or +NAME,-NAME to switch effects on and off");
   command
       .add_option("--set", options.settings, "Change PATH=VALUE for this run, e.g. gravity.z=-9.81; repeats")
       ->allow_extra_args(false);
}

void addRunOptions(CLI::App &command, RunOptions &options)
{
   addModelOptions(command, options);
   command
       .add_option("--probe", options.probes,
                   "Watch X,Y,Z:CHANNEL (x y z vx vy vz rx ry rz strain fx fy fz mx my mz); repeats")
       ->allow_extra_args(false);
   command.add_option("--record", options.record, "Write probes and energies over time as CSV");
   command.add_option("--state", options.state, "Write the final state of every cell: .csv, or JSON lines");
}

std::unique_ptr<Context::Input> openToRun(const RunOptions &options, Context &context,
                                          const std::function<Status(Design &)> &more)
{
   auto opened = openDesign(options.file, context.job());
   if (!opened) {
      context.fail(opened.error());
      return nullptr;
   }
   for (const std::string &text : opened->notes)
      context.note(text);
   Setup &setup = opened->design.setup;
   if (const std::string id = fullId(*context.catalogue(), DIATOM_SOLVER_1, options.solver);
       !id.empty() && id != setup.solver)
   {
      setup.solver = id;
      setup.solverValues.clear(); // they were another solver's
   }
   Status applied = apply(options, opened->design);
   if (applied && more)
      applied = more(opened->design);
   if (!applied) {
      context.fail(applied.error());
      return nullptr;
   }
   return context.prepare(*std::move(opened));
}

Result<std::vector<Probe>> parseProbes(const std::vector<std::string> &texts, const Scene &scene,
                                       bool ownOutputs)
{
   std::vector<Probe> probes;
   for (const std::string &text : texts) {
      auto probe = parseProbe(text, scene, ownOutputs);
      if (!probe)
         return probe.error();
      probes.push_back(*std::move(probe));
   }
   return probes;
}

Result<nlohmann::ordered_json> probeValues(const SolverRun &run, const std::vector<Probe> &probes,
                                           const Job &job)
{
   auto values = nlohmann::ordered_json::object();
   for (const Probe &probe : probes) {
      const auto value = run.probe(probe.cell, probe.channel, job);
      if (!value)
         return value.error();
      values[probe.name] = *value;
   }
   return values;
}

nlohmann::ordered_json effectsReport(const std::vector<Effect> &effects, bool json)
{
   if (json)
      return toJson(effects);
   auto lines = nlohmann::ordered_json::object();
   for (const Effect &effect : effects)
      lines[effect.name] = fmt::format("{}: {}", effect.on ? "on" : "off", effect.why);
   return lines;
}

} // namespace diatom::cli
