// diatom simulate: motion in time, with a record, probes and an account of the energy.
#include "cli/accuracy_option.h"
#include "cli/commands.h"
#include "cli/number_checks.h"
#include "cli/run_options.h"
#include "cli/scene_json.h"
#include "core/text.h"
#include "scene/simulation.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace diatom::cli {

namespace {

constexpr double kDefaultRows = 200; // of a record whose interval is not given
constexpr double kMostRows = 1e7;
constexpr std::size_t kEffort = 6; // numbers of the output "effort"

struct SimulateOptions
{
   RunOptions run;
   std::string integrator, precision, step, accuracy;
   double until = 0, every = 0, probeBudget = 30;
   std::optional<double> drag;
   bool force = false, reproducible = false;
};

/// What motion alone can be told.
Status applyOptions(const SimulateOptions &options, Setup &setup)
{
   if (!options.integrator.empty())
      setup.solverValues["integrator"] = options.integrator;
   if (!options.precision.empty())
      setup.solverValues["precision"] = options.precision;
   if (options.reproducible)
      setup.solverValues["reproducible"] = 1.0;
   if (options.force)
      setup.solverValues["force_step"] = 1.0;
   if (options.drag)
      setup.drag = *options.drag;
   if (options.step == "auto") {
      setup.step = 0;
   } else if (!options.step.empty()) {
      const auto step = parseNumber(options.step);
      if (!step || *step <= 0)
         return Error{ErrorCode::usage,
                      fmt::format("--step: \"{}\" is neither auto nor seconds above 0", options.step)};
      setup.step = *step;
   }
   return {};
}

/// Advances to the end, recording on the way.
Status runTo(Simulation &simulation, const SimulateOptions &options, Recorder *recorder, const Job &job)
{
   simulation.setGoal(options.until);
   if (!recorder)
      return simulation.advance(options.until, job);
   const double every = options.every > 0 ? options.every : options.until / kDefaultRows;
   if (options.until / every > kMostRows)
      return Error{ErrorCode::usage,
                   "--every is too short: the record would have more than ten million rows"};
   const auto rows = static_cast<std::int64_t>(std::ceil(options.until / every * (1 - 1e-12)));
   if (Status first = recorder->row(simulation.run(), job); !first)
      return first;
   for (std::int64_t k = 1; k <= rows; ++k) {
      const double until = k == rows ? options.until : every * static_cast<double>(k);
      if (Status advanced = simulation.advance(until, job); !advanced)
         return advanced;
      if (Status written = recorder->row(simulation.run(), job); !written)
         return written;
   }
   return {};
}

Result<nlohmann::ordered_json> summary(const Simulation &simulation, const std::vector<Probe> &probes,
                                       const char *status, bool forPrograms, const Job &job)
{
   const auto energy = simulation.energy(job);
   if (!energy)
      return energy.error();
   const auto momentum = simulation.momentum(job);
   if (!momentum)
      return momentum.error();
   const double cellSteps =
       static_cast<double>(simulation.steps()) * static_cast<double>(simulation.scene().cells());
   nlohmann::ordered_json object{
       {"status", status},
       {"cells", simulation.scene().cells()},
       {"links", simulation.scene().view().links},
       {"time_s", simulation.time()},
       {"steps", simulation.steps()},
       {"step_s", simulation.step()},
       {"stable_step_s", simulation.stableStep() > 0 ? nlohmann::ordered_json(simulation.stableStep())
                                                     : nlohmann::ordered_json(nullptr)},
       {"wall_s", simulation.wallSeconds()},
       {"ns_per_cell_step", cellSteps > 0 ? 1e9 * simulation.wallSeconds() / cellSteps : 0.0}};
   if (simulation.run().hasOutput("effort")) {
      const auto effort = simulation.output("effort", job);
      if (!effort)
         return effort.error();
      if (effort->size() >= kEffort)
         object["solver_effort"] = {{"newton_iterations", (*effort)[1]},
                                    {"factorisations", (*effort)[2]},
                                    {"repeated_steps", (*effort)[3]},
                                    {"shortest_step_s", (*effort)[4]},
                                    {"longest_step_s", (*effort)[5]}};
   }
   object["effects"] = effectsReport(simulation.scene().effects(), forPrograms);
   object["energy"] = {
       {"kinetic", energy->kinetic}, {"elastic", energy->elastic},       {"gravity", energy->gravity},
       {"contact", energy->contact}, {"dissipated", energy->dissipated}, {"work", energy->work},
       {"drift", energy->drift}};
   const auto vector = [](const Vec3 &v) { return nlohmann::ordered_json{v.x(), v.y(), v.z()}; };
   object["momentum"] = {{"linear", vector(momentum->linear)}, {"angular", vector(momentum->angular)}};
   auto values = probeValues(simulation.run(), probes, job);
   if (!values)
      return values.error();
   object["probes"] = *std::move(values);
   object["problems"] = toJson(simulation.scene().networks().problems);
   return object;
}

Status finishFiles(const Simulation &simulation, const Model &model, const SimulateOptions &options,
                   Recorder *recorder, const Status &ran, const Job &job)
{
   if (recorder)
      if (Status kept = recorder->finish(ran ? "" : ran.error().message); !kept)
         return kept;
   return options.run.state.empty() || !ran ? Status()
                                            : writeState(simulation.run(), model, options.run.state, job);
}

struct Started
{
   std::unique_ptr<Simulation> simulation;
   std::vector<Probe> probes;
};

Result<Started> start(const Context::Input &input, const SimulateOptions &options, Context &context)
{
   const Setup &setup = input.opened.design.setup;
   auto scene = Scene::build(*input.hierarchy, setup, context.job());
   if (!scene)
      return scene.error();
   Started started;
   auto probes = parseProbes(options.run.probes, **scene);
   if (!probes)
      return probes.error();
   started.probes = *std::move(probes);
   auto simulation = Simulation::start(context.catalogue(), *std::move(scene), setup, {}, context.job());
   if (!simulation)
      return simulation.error();
   started.simulation = *std::move(simulation);
   return started;
}

/// Settings by --accuracy; nothing where it was not asked for.
Result<std::optional<AccuracyChoice>> choose(const SimulateOptions &options, Context::Input &input,
                                             Context &context)
{
   if (options.accuracy.empty())
      return std::optional<AccuracyChoice>();
   if (!options.step.empty() || options.force)
      return Error{ErrorCode::usage, "--accuracy chooses the step: leave out --step and --force-step"};
   const auto error = parseAccuracy(options.accuracy);
   if (!error)
      return error.error();
   AccuracyAsked asked{*error, options.until, "", options.probeBudget, {}};
   if (!options.run.probes.empty())
      asked.quantity = options.run.probes.front();
   if (!options.integrator.empty())
      asked.fixed["integrator"] = options.integrator;
   if (!options.precision.empty())
      asked.fixed["precision"] = options.precision;
   auto choice = applyAccuracy(asked, input, input.opened.design.setup, context);
   if (!choice)
      return choice.error();
   return std::optional(*std::move(choice));
}

void simulate(const SimulateOptions &options, Context &context)
{
   const auto input =
       openToRun(options.run, context, [&](Design &design) { return applyOptions(options, design.setup); });
   if (!input)
      return;
   const auto choice = choose(options, *input, context);
   if (!choice)
      return context.fail(choice.error());
   auto started = start(*input, options, context);
   if (!started)
      return context.fail(started.error());
   Simulation &simulation = *started->simulation;
   for (const Problem &problem : simulation.scene().networks().problems)
      context.note("warning: " + problem.text);

   std::optional<Recorder> recorder;
   if (!options.run.record.empty())
      recorder.emplace(options.run.record, started->probes, simulation.run());
   const Status ran = runTo(simulation, options, recorder ? &*recorder : nullptr, context.job());
   const Job calm; // what is read after a cancel must not be cancelled itself
   const char *status = ran                                        ? "done"
                        : ran.error().code == ErrorCode::unstable  ? "unstable"
                        : ran.error().code == ErrorCode::cancelled ? "cancelled"
                                                                   : "failed";
   if (Status kept = finishFiles(simulation, input->opened.design.model, options,
                                 recorder ? &*recorder : nullptr, ran, calm);
       !kept)
      return context.fail(kept.error());
   if (!ran && std::string_view(status) == "failed")
      return context.fail(ran.error());
   auto object = summary(simulation, started->probes, status, context.json, calm);
   if (!object)
      return context.fail(object.error());
   if (*choice)
      (*object)["accuracy"] = choiceJson(**choice, simulation.wallSeconds());
   context.print(*object);
   if (!ran)
      context.fail(ran.error());
}

} // namespace

void addSimulate(CLI::App &app, Context &context)
{
   const auto options = std::make_shared<SimulateOptions>();
   CLI::App *command =
       app.add_subcommand("simulate", "Simulate motion in time; prints energies, effects and probes");
   addRunOptions(*command, options->run);
   command->add_option("--until", options->until, "Time to simulate, s")->required()->check(kPositive);
   command->add_option("--integrator", options->integrator,
                       "The solver's integrator, e.g. semi_implicit, verlet, rk4, implicit");
   command->add_option("--precision", options->precision, "The solver's numbers: f64 or f32");
   command->add_flag("--reproducible", options->reproducible,
                     "The same bits on any processor and from any compiler");
   command->add_option("--step", options->step,
                       "Time step in s, or auto for the solver's own: the stable one, or with the implicit "
                       "integrator what the motion asks for (default: the design's)");
   command->add_option("--accuracy", options->accuracy,
                       "Choose integrator and step: the cheapest that keep the first --probe, else "
                       "the cell that moves most, within this error, as 1% or 0.01");
   command
       ->add_option("--probe-budget", options->probeBudget,
                    "Wall time, s, that --accuracy may spend on each setting it considers")
       ->check(kPositive);
   command->add_flag("--force-step", options->force, "Accept a step beyond the stable limit");
   command->add_option("--drag", options->drag, "Slow all motion, 1/s: settles a design to rest")
       ->check(kNonNegative);
   command->add_option("--every", options->every, "Interval of the record, s")->check(kPositive);
   command->footer("Examples:\n  diatom simulate beam.diatom --until 0.5 --record out.csv --probe 0,13,0:z\n"
                   "  diatom simulate beam.diatom --until 0.5 --probe 0,13,0:z --accuracy 1%\n"
                   "  diatom simulate gripper.json --until 0.2 --step auto --effects=-gravity --json");
   command->callback([options, &context] { simulate(*options, context); });
}

} // namespace diatom::cli
