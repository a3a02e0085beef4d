// diatom solve: the static balance of a design, what its supports supply, and how far it gave way; or the
// steady state that a solver of another physics finds.
#include "cli/commands.h"
#include "cli/deformed_stl.h"
#include "cli/number_checks.h"
#include "cli/run_options.h"
#include "cli/scene_json.h"
#include "scene/balance.h"
#include "scene/problems.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace diatom::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kMostCurveRows = 1e6;

struct SolveOptions
{
   RunOptions run;
   std::optional<double> at, tolerance;
   double every = 0, scale = 1;
   int loadSteps = 0;
   std::string stl, links;
};

Json vectorJson(const Vec3 &v) { return {v.x(), v.y(), v.z()}; }

Json wrenchJson(const Wrench &wrench)
{
   return {{"force_N", vectorJson(wrench.force)}, {"moment_N_m", vectorJson(wrench.moment)}};
}

/// What may have no balance is told, what has none refused.
Status noteLoose(const Context::Input &input, Context &context)
{
   const auto loose = checkHeld(*input.hierarchy, input.opened.design.setup, context.job());
   if (!loose)
      return loose.error();
   for (const Problem &problem : *loose)
      context.note("warning: " + problem.text);
   return {};
}

Json largestDisplacement(const SolverRun &run, const Frame &frame)
{
   const double *rest = run.scene().view().cell_position;
   std::int64_t most = 0;
   Vec3 largest = Vec3::Zero();
   for (std::int64_t cell = 0; cell < run.scene().cells(); ++cell) {
      const Vec3 moved =
          Eigen::Map<const Vec3>(frame.position.data() + 3 * cell) - Eigen::Map<const Vec3>(rest + 3 * cell);
      if (moved.norm() > largest.norm()) {
         largest = moved;
         most = cell;
      }
   }
   return {{"m", largest.norm()},
           {"cell", toJson(run.scene().indices()[static_cast<std::size_t>(most)])},
           {"vector_m", vectorJson(largest)}};
}

template<typename Item>
Json entriesJson(const std::vector<Item> &items, const std::vector<Wrench> &wrenches)
{
   auto list = Json::array();
   for (std::size_t i = 0; i < items.size(); ++i) {
      Json row{{"on", whereText(items[i].where)}};
      if constexpr (std::is_same_v<Item, Drive>)
         row["freedom"] = kFreedoms[static_cast<std::size_t>(items[i].freedom)];
      row.update(wrenchJson(wrenches[i]));
      list.push_back(std::move(row));
   }
   return list;
}

/// What supports supply beside what acts, and what is left between them.
Result<Json> reactionsReport(const SolverRun &run, const Setup &setup, const Job &job)
{
   const auto reactions = reactionsOf(run, setup, job);
   if (!reactions)
      return reactions.error();
   const auto loads = loadsOn(run, job);
   if (!loads)
      return loads.error();
   Json report{{"total", wrenchJson(reactions->total)}, {"loads", wrenchJson(*loads)}};
   if (!setup.ground.present) // which supplies the rest
      report["unbalanced_N"] = (reactions->total.force + loads->force).norm();
   report["supports"] = entriesJson(setup.supports, reactions->supports);
   report["drives"] = entriesJson(setup.drives, reactions->drives);
   return report;
}

/// Of outputs that are the solver's own: the least and the greatest value with their cells, or the numbers of
/// the whole.
Result<Json> outputsReport(const SolverRun &run, const Job &job)
{
   auto report = Json::object();
   for (const SolverRun::Told &told : run.told()) {
      const auto values = run.output(told.name, job);
      if (!values)
         return values.error();
      const std::string name = told.unit.empty() ? told.name : fmt::format("{} ({})", told.name, told.unit);
      if (told.rows == 1 && values->size() <= 16) {
         report[name] = *values;
         continue;
      }
      if (values->empty())
         continue;
      const auto [least, greatest] = std::minmax_element(values->begin(), values->end());
      Json row{{"least", *least}, {"greatest", *greatest}};
      if (told.rows == run.scene().cells() && !told.name.starts_with("link_")) {
         const auto cell = [&](auto place) {
            return toJson(
                run.scene().indices()[static_cast<std::size_t>((place - values->begin()) / told.stride)]);
         };
         row["least_at"] = cell(least);
         row["greatest_at"] = cell(greatest);
      }
      report[name] = std::move(row);
   }
   return report;
}

Result<Json> report(const Balance &balance, const Setup &setup, const std::vector<Probe> &probes, bool json,
                    const Job &job)
{
   const SolverRun &run = *balance.run;
   Json object{
       {"status", "done"},           {"cells", run.scene().cells()}, {"links", run.scene().view().links},
       {"time_s", run.time()},       {"residual", balance.residual}, {"iterations", balance.iterations},
       {"wall_s", run.wallSeconds()}};
   if (run.hasOutput("position") && run.hasOutput("rotation")) {
      const auto frame = run.frame(job);
      if (!frame)
         return frame.error();
      object["largest_displacement"] = largestDisplacement(run, *frame);
   }
   if (run.hasOutput("reaction")) {
      auto reactions = reactionsReport(run, setup, job);
      if (!reactions)
         return reactions;
      object["reactions"] = *std::move(reactions);
   }
   if (!run.mechanics()) {
      auto outputs = outputsReport(run, job);
      if (!outputs)
         return outputs;
      object["outputs"] = *std::move(outputs);
   }
   std::vector<Effect> effects = run.scene().effects();
   if (!run.mechanics())
      std::erase_if(effects, [](const Effect &effect) { return effectIsMechanical(effect.name); });
   object["effects"] = effectsReport(effects, json);
   auto values = probeValues(run, probes, job);
   if (!values)
      return values;
   object["probes"] = *std::move(values);
   object["problems"] = toJson(run.scene().networks().problems);
   return object;
}

/// Rows of the record beyond probes and energies.
const std::vector<std::string> &columns(const Setup &setup)
{
   static const std::vector<std::string> kPlain{"residual"},
       kDriven{"residual",        "driven fx (N)",   "driven fy (N)",  "driven fz (N)",
               "driven mx (N m)", "driven my (N m)", "driven mz (N m)"};
   return setup.drives.empty() ? kPlain : kDriven;
}

Status addRow(Recorder &recorder, const Balance &balance, const Setup &setup, const Job &job)
{
   std::vector<double> values{balance.residual};
   if (!setup.drives.empty()) {
      const auto reactions = reactionsOf(*balance.run, setup, job);
      if (!reactions)
         return reactions.error();
      for (const Vec3 &part : {reactions->driven.force, reactions->driven.moment})
         values.insert(values.end(), part.begin(), part.end());
   }
   return recorder.row(*balance.run, job, values);
}

/// Times of balances from 0 to the end, the end alone without an interval.
Result<std::vector<double>> timesOf(const SolveOptions &options, double end)
{
   if (options.every <= 0)
      return std::vector<double>{end};
   if (end / options.every > kMostCurveRows)
      return Error{ErrorCode::usage, "--every is too short: there would be more than a million balances"};
   std::vector<double> times;
   const auto last = static_cast<std::int64_t>(std::ceil(end / options.every * (1 - 1e-12)));
   for (std::int64_t k = 0; k < last; ++k)
      times.push_back(options.every * static_cast<double>(k));
   times.push_back(end);
   return times;
}

/// The balances at these times, each recorded; the last one is handed back.
Result<Balance> balances(const SolveOptions &options, const Setup &setup, const std::vector<double> &times,
                         std::unique_ptr<Scene> scene, const std::vector<Probe> &probes, Context &context)
{
   const double tolerance = options.tolerance.value_or(BalanceRequest().tolerance);
   auto balance = solveStatics(context.catalogue(), std::move(scene), setup, {}, {times.front(), tolerance},
                               context.job());
   if (!balance)
      return balance;
   std::optional<Recorder> recorder;
   if (!options.run.record.empty())
      recorder.emplace(options.run.record, probes, *balance->run, columns(setup));
   Status went;
   for (std::size_t k = 0; k < times.size() && went; ++k) {
      if (k > 0)
         went = rebalance(*balance, times[k], tolerance, context.job());
      if (went && recorder)
         went = addRow(*recorder, *balance, setup, context.job());
   }
   if (recorder)
      if (Status kept = recorder->finish(went ? "" : went.error().message); !kept)
         return kept.error();
   if (!went)
      return went.error();
   return balance;
}

Status solveInput(const Context::Input &input, const SolveOptions &options, Context &context)
{
   const Setup &setup = input.opened.design.setup;
   const auto physics = solverPhysics(*context.catalogue(), setup.solver, context.job());
   if (!physics)
      return physics.error();
   const bool mechanics = std::find(physics->begin(), physics->end(), kMechanics) != physics->end();
   if (Status held = mechanics ? noteLoose(input, context) : Status(); !held)
      return held;
   const auto times = timesOf(options, options.at.value_or(endOfCurves(setup)));
   if (!times)
      return times.error();
   auto scene = Scene::build(*input.hierarchy, setup, context.job(), Analysis::statics);
   if (!scene)
      return scene.error();
   const auto probes = parseProbes(options.run.probes, **scene, !mechanics);
   if (!probes)
      return probes.error();
   for (const Problem &problem : (*scene)->networks().problems)
      context.note("warning: " + problem.text);
   const auto balance = balances(options, setup, *times, *std::move(scene), *probes, context);
   if (!balance)
      return balance.error();
   const Model &model = input.opened.design.model;
   if (!options.run.state.empty())
      if (Status kept = writeState(*balance->run, model, options.run.state, context.job()); !kept)
         return kept;
   if (!options.links.empty())
      if (Status kept = writeLinks(*balance->run, options.links, context.job()); !kept)
         return kept;
   if (!options.stl.empty())
      if (const auto kept =
              writeDeformedStl(*input.hierarchy, *balance->run, options.scale, options.stl, context.job());
          !kept)
         return kept.error();
   const auto object = report(*balance, setup, *probes, context.json, context.job());
   if (!object)
      return object.error();
   context.print(*object);
   return {};
}

void solve(const SolveOptions &options, Context &context)
{
   const auto input = openToRun(options.run, context, [&](Design &design) {
      if (options.loadSteps > 0)
         design.setup.solverValues["load_steps"] = static_cast<double>(options.loadSteps);
      return Status();
   });
   if (!input)
      return;
   if (const Status solved = solveInput(*input, options, context); !solved)
      context.fail(solved.error());
}

} // namespace

void addSolve(CLI::App &app, Context &context)
{
   const auto options = std::make_shared<SolveOptions>();
   CLI::App *command = app.add_subcommand(
       "solve", "Find the static balance, or the steady state of another physics; prints residual, "
                "displacement, reactions, outputs and probes");
   addRunOptions(*command, options->run);
   command
       ->add_option("--at", options->at,
                    "Time at which curves and signals are taken, s (default: the end of the longest curve)")
       ->check(kNonNegative);
   command->add_option("--load-steps", options->loadSteps, "Raise loads in so many steps; 0 = as few as work")
       ->check(kNonNegative);
   command
       ->add_option("--tolerance", options->tolerance,
                    "Unbalanced force over the largest force at work that is small enough (default 1e-8)")
       ->check(kPositive);
   command
       ->add_option("--every", options->every,
                    "Also find the balances before, at this interval, s: for --record")
       ->check(kPositive);
   command->add_option("--links", options->links,
                       "Write what the solver tells of every link between two cells, as CSV");
   command->add_option("--stl", options->stl, "Write the deformed surface as STL, in mm");
   command->add_option("--scale", options->scale, "Exaggerate displacements in the STL by this factor");
   command->footer("Examples:\n  diatom solve beam.diatom --probe 0,13,0:z\n"
                   "  diatom solve flexure.diatom --every 0.1 --record pull.csv --stl bent.stl --scale 10");
   command->callback([options, &context] { solve(*options, context); });
}

} // namespace diatom::cli
