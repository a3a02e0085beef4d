#include "study/motion_time.h"

#include "plugins/warnings.h"
#include "study/settings.h"
#include "study/step_limit.h"

#include <algorithm>

namespace diatom {

namespace {

constexpr double kMostSteps = 20'000;
constexpr double kStretch = 16; // steps between looks
/// A stop is where the kinetic energy is below this part of its peak: higher modes keep it above zero.
constexpr double kStopped = 0.1;

/// Period of the slowest source with a voltage; 0 without one.
double slowestPeriod(const Setup &setup)
{
   double period = 0;
   for (const Source &source : setup.sources)
      if (source.amplitude != 0 && source.frequency > 0)
         period = std::max(period, 1 / source.frequency);
   return period;
}

/// What looks are told in: the stable step, also where the scene is stepped without such a limit.
Result<double> lookStep(const Subject &subject, double stable, const Job &job)
{
   constexpr std::string_view kAxis[] = {"integrator"};
   if (stable > 0)
      return stable;
   const auto choices =
       solverChoices(*subject.catalogue, subject.setup.solver, subject.setup.solverValues, kAxis);
   for (const Values &values : combinations(choices))
      if (const auto limit = findStepLimit(subject, values, job); limit && limit->stableStep > 0)
         return limit->stableStep;
   return Error{ErrorCode::usage, "nothing tells how long this scene moves; say how long to watch it"};
}

} // namespace

Result<double> motionTime(const Subject &subject, const Job &job)
{
   const RemarksMuted muted; // nobody sees this run
   auto started = startTrial(subject, {}, 0, job);
   if (!started)
      return started.error();
   Simulation &simulation = **started;
   if (const double period = slowestPeriod(subject.setup);
       period > 0 && !simulation.scene().networks().actuators.empty())
      return period;
   const auto step = lookStep(subject, simulation.stableStep(), job);
   if (!step)
      return step.error();
   const double most = kMostSteps * *step, stretch = kStretch * *step;
   simulation.setGoal(most);
   double peak = 0, stopped = 0;
   for (int look = 1; look * stretch < most; ++look) {
      if (const Status advanced = simulation.advance(look * stretch, job); !advanced)
         return advanced.error();
      const auto energy = simulation.energy(job);
      if (!energy)
         return energy.error();
      peak = std::max(peak, energy->kinetic);
      if (energy->kinetic < kStopped * peak && stopped == 0)
         stopped = simulation.time();
      if (stopped > 0)
         break;
   }
   return stopped > 0 ? 2 * stopped : most;
}

} // namespace diatom
