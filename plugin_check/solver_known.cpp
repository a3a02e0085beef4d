#include "plugin_check/solver_scene.h"

#include "scene/simulation.h"
#include "scene/solver_run.h"

#include <fmt/format.h>

#include <cmath>

namespace diatom::check {

namespace {

double relative(double found, double expected) { return std::abs(found - expected) / std::abs(expected); }

/// Tension: each of the bonds between the centres of `length` cells gives way by F / (E p), p the pitch.
void checkTension(const Subject &subject, Findings &findings)
{
   constexpr int kLength = 11;
   constexpr double kForce = 1e-3; // N: strains of 1e-4
   Trial trial{"tension", barDesign(subject, kLength, 1), Analysis::statics};
   Load load;
   load.where = Index{kLength - 1, 0, 0};
   load.force = {kForce, 0, 0};
   trial.design.setup.loads.push_back(load);
   const auto answers = runTrial(subject, trial, {});
   if (!answers)
      return findings.fail("a bar in tension: " + answers.error().message);
   const auto position = answers->find("position");
   if (position == answers->end())
      return findings.fail("a bar in tension: it has no output 'position'");
   const double expected = (kLength - 1) * kForce / (kBarModulus * kBarPitch);
   const auto place = [&](std::size_t cell) { return position->second[3 * cell]; };
   const double found = place(kLength - 1) - place(0) - (kLength - 1) * kBarPitch;
   if (relative(found, expected) > 0.01) // strains of 1e-4: what bends and turns is far below
      findings.fail(
          fmt::format("a bar in tension grows by {:.4g} m, where F l / (E A) is {:.4g} m", found, expected));
}

/// Free fall: nothing holds the bar.
void checkFall(const Subject &subject, Findings &findings)
{
   constexpr double kGravity = 9.81;
   Trial trial{"free fall", barDesign(subject, 3, 1), Analysis::dynamics};
   trial.design.setup.supports.clear();
   trial.design.setup.gravity = {0, 0, -kGravity};
   auto scene = trial.scene(subject);
   if (!scene)
      return findings.fail(scene.error().message);
   const double rest = (*scene)->view().cell_position[2];
   auto run = SolverRun::create(subject.catalogue, *std::move(scene), trial.design.setup, {}, Job());
   if (!run)
      return findings.fail("free fall: " + run.error().message);
   diatom_step_result result = emptyResult();
   const Status stepped = (*run)->step(requestOf(1000), result, Job());
   const auto position = (*run)->read("position", 0, 1, Job());
   if (!stepped || !position || !(result.time > 0))
      return findings.fail("free fall: it does not step, or tells no time and place");
   const double expected = kGravity / 2 * result.time * result.time, found = rest - (*position)[2];
   if (relative(found, expected) > 0.005) // a first-order rule is off by one step in a thousand
      findings.fail(fmt::format("in {:.4g} s it falls {:.4g} m, where g t^2 / 2 is {:.4g} m", result.time,
                                found, expected));
}

/// An undamped bar let go under its weight swings for ever.
void checkEnergy(const Subject &subject, Findings &findings)
{
   Trial trial{"swing", barDesign(subject, 8, 1), Analysis::dynamics};
   trial.design.setup.gravity = {0, 0, -9.81};
   auto scene = trial.scene(subject);
   if (!scene)
      return findings.fail(scene.error().message);
   auto simulation = Simulation::start(subject.catalogue, *std::move(scene), trial.design.setup, {}, Job());
   if (!simulation)
      return findings.fail("an undamped bar: " + simulation.error().message);
   const double step = (*simulation)->step() > 0 ? (*simulation)->step() : (*simulation)->stableStep();
   const Status advanced = (*simulation)->advance(2000 * step, Job());
   const auto energy = (*simulation)->energy(Job());
   if (!advanced || !energy)
      return findings.fail("an undamped bar: " + (advanced ? energy.error() : advanced.error()).message);
   if (std::abs(energy->drift) > 0.01)
      findings.fail(fmt::format("an undamped bar gains or loses {:.1f} % of its energy in 2000 steps",
                                100 * energy->drift));
}

} // namespace

void checkSolverKnown(const Subject &subject, Findings &findings)
{
   const auto can = abilitiesOf(subject);
   if (!can)
      return findings.fail(can.error().message);
   const bool cubes = can->has(can->lattices, "*") || can->has(can->lattices, LatticeSpec().id);
   if (!can->mechanics() || !cubes)
      return findings.skip(
          "answers are known for mechanics of cubes only; the author's own tests know the others");
   if (can->can(Analysis::statics))
      checkTension(subject, findings);
   if (can->can(Analysis::dynamics)) {
      checkFall(subject, findings);
      checkEnergy(subject, findings);
   }
}

} // namespace diatom::check
