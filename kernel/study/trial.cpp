#include "study/trial.h"

#include "core/clock.h"
#include "plugins/warnings.h"
#include "study/refine.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace diatom {

double median(std::vector<double> values)
{
   if (values.empty())
      return 0;
   const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
   std::nth_element(values.begin(), middle, values.end());
   return *middle;
}

Result<std::unique_ptr<Simulation>> startTrial(const Subject &subject, const Values &values, double step,
                                               const Job &job)
{
   Setup setup = subject.setup;
   setup.step = step;
   auto scene = Scene::build(*subject.hierarchy, setup, job);
   if (!scene)
      return scene.error();
   return Simulation::start(subject.catalogue, *std::move(scene), setup, values, job);
}

Result<std::vector<std::int64_t>> quantityCells(const Subject &subject, const Quantity &quantity,
                                                const Scene &scene)
{
   std::vector<std::int64_t> cells;
   const int times = subject.resolution;
   for (std::int32_t x = 0; x < times; ++x)
      for (std::int32_t y = 0; y < times; ++y)
         for (std::int32_t z = 0; z < times; ++z)
            cells.push_back(scene.cellAt(refinedIndex(quantity.cell, times) + Index{x, y, z}));
   if (std::find(cells.begin(), cells.end(), -1) != cells.end())
      return Error{ErrorCode::usage,
                   fmt::format("the quantity {} is of a cell that is not there", quantity.text())};
   return cells;
}

namespace {

Result<double> meanOf(const Simulation &simulation, const std::vector<std::int64_t> &cells,
                      const std::string &channel, const Job &job)
{
   double sum = 0;
   for (const std::int64_t cell : cells) {
      const auto value = simulation.probe(cell, channel, job);
      if (!value)
         return value.error();
      sum += *value;
   }
   return sum / static_cast<double>(cells.size());
}

} // namespace

Result<TrialRun> runTrial(const Subject &subject, const Values &values, const Quantity &quantity,
                          double until, std::int64_t samples, std::int64_t perSample, const Job &job)
{
   const RemarksMuted muted; // the run that is chosen tells
   const double stretch = until / static_cast<double>(samples);
   const double step = stretch / static_cast<double>(perSample);
   const auto start = Clock::now();
   // A hair above, so that rounding of the sample times cannot add a step to a stretch.
   auto started = startTrial(subject, values, step * (1 + 1e-9), job);
   if (!started)
      return started.error();
   Simulation &simulation = **started;
   const auto cells = quantityCells(subject, quantity, simulation.scene());
   if (!cells)
      return cells.error();
   TrialRun run;
   run.seconds = secondsSince(start);
   run.cells = simulation.scene().cells();
   run.step = step;
   std::vector<double> stretches;
   simulation.setGoal(until);
   for (std::int64_t k = 0; k <= samples; ++k) {
      const double time = k == samples ? until : stretch * static_cast<double>(k);
      const auto before = Clock::now();
      if (k > 0)
         if (const Status advanced = simulation.advance(time, job); !advanced)
            return advanced.error();
      if (k > 0)
         stretches.push_back(secondsSince(before));
      const auto value = meanOf(simulation, *cells, quantity.channel, job);
      if (!value)
         return value.error();
      run.curve.time.push_back(time);
      run.curve.value.push_back(*value);
   }
   for (const double one : stretches)
      run.seconds += one;
   run.steps = simulation.steps();
   run.stepSeconds = median(stretches) / static_cast<double>(perSample);
   return run;
}

Result<double> timeStep(const Subject &subject, const Values &values, double step, double until,
                        double seconds, const Job &job)
{
   const RemarksMuted muted;         // the run that is chosen tells
   constexpr double kStretch = 2e-3; // s: the clock, the call and a look at the energies are nothing to it
   constexpr std::size_t kFewest = 3, kMost = 200;
   auto started = startTrial(subject, values, step, job);
   if (!started)
      return started.error();
   Simulation &simulation = **started;
   simulation.setGoal(until);
   std::vector<double> times;
   double length = 4; // steps
   const auto start = Clock::now();
   while (times.size() < kFewest || (secondsSince(start) < seconds && times.size() < kMost)) {
      const std::int64_t before = simulation.steps();
      const auto begun = Clock::now();
      if (const Status advanced = simulation.advance(std::min(simulation.time() + length * step, until), job);
          !advanced)
         return advanced.error();
      const std::int64_t done = simulation.steps() - before;
      if (done == 0)
         break;
      const double took = secondsSince(begun);
      const bool brief = took < kStretch && simulation.time() < until;
      // The first stretches warm up; a longer one of the same kind replaces them.
      if (brief && secondsSince(start) < std::max(seconds, kStretch)) {
         length *= 2;
         times.clear();
      }
      times.push_back(took / static_cast<double>(done));
   }
   return median(times);
}

Result<double> ownStep(const Subject &subject, const Values &values, double until, double seconds,
                       const Job &job)
{
   const RemarksMuted muted;      // the run that is chosen tells
   constexpr int kStretches = 64; // after each of which the clock is looked at
   auto started = startTrial(subject, values, 0, job);
   if (!started)
      return started.error();
   Simulation &simulation = **started;
   simulation.setGoal(until);
   const auto start = Clock::now();
   for (int k = 1; k <= kStretches; ++k) {
      if (const Status advanced = simulation.advance(until * k / kStretches, job); !advanced)
         return advanced.error();
      if (secondsSince(start) > seconds)
         break;
   }
   return simulation.time() / static_cast<double>(std::max<std::int64_t>(1, simulation.steps()));
}

} // namespace diatom
