#include "study/stability_course.h"

#include "study/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace diatom::stability {

namespace {

constexpr double kHair = 1e-9;

/// The momentum (kg m/s; kg m2/s about the origin) that a body of this mass, size and kinetic energy could
/// have at most: what a change of it is measured by.
struct Scale
{
   double mass = 0, reach = 0; // kg, m from the origin
   double linear(double kinetic) const { return std::sqrt(2 * kinetic * mass); }
   double angular(double kinetic) const { return linear(kinetic) * reach; }
};

class Watch
{
public:
   Watch(const Simulation &simulation, const Job &job, Scale scale, Course &course)
       : m_simulation(simulation), m_job(job), m_scale(scale), m_course(course)
   {}

   Status begin()
   {
      const auto energy = m_simulation.energy(m_job);
      const auto momentum = m_simulation.momentum(m_job);
      if (!energy || !momentum)
         return energy ? momentum.error() : energy.error();
      m_course.start = m_course.end = *energy;
      m_momentum = *momentum;
      m_course.mostEnergy = stored(*energy);
      m_course.mostKinetic = energy->kinetic;
      return {};
   }
   Status look()
   {
      const auto energy = m_simulation.energy(m_job);
      const auto momentum = m_simulation.momentum(m_job);
      if (!energy || !momentum)
         return energy ? momentum.error() : energy.error();
      m_course.end = *energy;
      m_course.mostEnergy = std::max(m_course.mostEnergy, stored(*energy));
      m_course.mostKinetic = std::max(m_course.mostKinetic, energy->kinetic);
      m_course.drift = std::max(m_course.drift, std::abs(energy->drift));
      m_linear = std::max(m_linear, (momentum->linear - m_momentum.linear).norm());
      m_angular = std::max(m_angular, (momentum->angular - m_momentum.angular).norm());
      return {};
   }
   void finish()
   {
      const Energy &end = m_course.end;
      const double through = std::max(end.dissipated, m_course.mostEnergy);
      const double balance = stored(end) + end.dissipated - end.work - stored(m_course.start);
      m_course.unaccounted = through > 0 ? std::abs(balance) / through : 0;
      m_course.travel = m_momentum.linear.norm() / m_scale.mass * m_simulation.time();
      const double kinetic = m_course.mostKinetic;
      m_course.linear = kinetic > 0 ? m_linear / m_scale.linear(kinetic) : 0;
      m_course.angular = kinetic > 0 ? m_angular / m_scale.angular(kinetic) : 0;
   }
   double stored(const Energy &energy) const
   {
      return energy.kinetic + energy.elastic + energy.contact + energy.gravity - m_course.start.gravity;
   }

private:
   const Simulation &m_simulation;
   const Job &m_job;
   Scale m_scale;
   Course &m_course;
   Momentum m_momentum;
   double m_linear = 0, m_angular = 0;
};

double reachOf(const Simulation &simulation)
{
   const diatom_scene &view = simulation.scene().view();
   double reach = 0;
   for (std::int64_t i = 0; i < view.cells; ++i) {
      const double *at = view.cell_position + 3 * i;
      reach = std::max(reach, std::hypot(at[0], at[1], at[2]));
   }
   return reach;
}

} // namespace

std::string Settings::text() const
{
   const std::string name = precision == "f64" ? integrator : integrator + " " + precision;
   return step > 0 ? fmt::format("{}, step {:g} s", name, step)
                   : fmt::format("{}, {:g} of the limit", name, ofLimit);
}

Result<std::unique_ptr<Simulation>> begin(const Bench &bench, const Design &design, const Settings &settings)
{
   const auto lattice = Lattice::make(*bench.catalogue, design.model.lattice, bench.job);
   if (!lattice)
      return lattice.error();
   const Subject subject{bench.catalogue, std::make_shared<const Hierarchy>(*lattice, design.model),
                         design.setup, 1};
   Values values{{"integrator", settings.integrator}, {"precision", settings.precision}};
   if (settings.force)
      values["force_step"] = 1.0;
   double step = settings.step;
   if (step == 0) {
      const auto probe = startTrial(subject, values, 0, bench.job);
      if (!probe)
         return probe.error();
      step = settings.ofLimit * (*probe)->stableStep();
   }
   // A hair above, so that rounding of the samples' times cannot add a step.
   return startTrial(subject, values, step * (1 + kHair), bench.job);
}

Result<Course> follow(const Bench &bench, const Design &design, const Settings &settings, std::int64_t steps,
                      std::int64_t samples, bool dense)
{
   auto started = begin(bench, design, settings);
   if (!started)
      return started.error();
   Simulation &simulation = **started;
   Course course;
   course.cells = simulation.scene().cells();
   const double step = simulation.step() / (1 + kHair);
   course.step = step;
   const auto lattice = Lattice::make(*bench.catalogue, design.model.lattice, bench.job);
   course.mass = Hierarchy(*lattice, design.model).mass().mass;
   Watch watch(simulation, bench.job, {course.mass, reachOf(simulation)}, course);
   if (const Status begun = watch.begin(); !begun)
      return begun.error();
   const std::int64_t tenth = steps / 10, stride = std::max<std::int64_t>(1, steps / samples);
   double first = 0, last = 0;
   std::int64_t inFirst = 0, inLast = 0;
   simulation.setGoal(static_cast<double>(steps) * step);
   for (std::int64_t done = 0; done < steps;) {
      const bool inTenth = done < tenth || done >= steps - tenth;
      std::int64_t next = std::min(steps, done + (dense && inTenth ? 1 : stride));
      if (dense && !inTenth)
         next = std::min(next, steps - tenth);
      const Status advanced = simulation.advance(static_cast<double>(next) * step, bench.job);
      if (!advanced && advanced.error().code != ErrorCode::unstable)
         return advanced.error();
      if (const Status looked = watch.look(); !looked)
         return looked.error();
      if (!advanced) {
         course.stopped = advanced.error();
         course.lost = simulation.steps() - std::llround(simulation.time() / step);
         break;
      }
      done = next;
      if (done <= tenth) {
         first += watch.stored(course.end);
         ++inFirst;
      } else if (done > steps - tenth) {
         last += watch.stored(course.end);
         ++inLast;
      }
   }
   watch.finish();
   course.steps = simulation.steps();
   course.time = simulation.time();
   course.firstTenth = inFirst > 0 ? first / static_cast<double>(inFirst) : 0;
   course.lastTenth = inLast > 0 ? last / static_cast<double>(inLast) : 0;
   return course;
}

void tell(const Course &course, const Settings &settings, StabilityRow &row)
{
   row.how = settings.text();
   row.cells = course.cells;
   row.steps += course.steps;
   if (course.stopped)
      row.failure = course.stopped->message;
}

} // namespace diatom::stability
