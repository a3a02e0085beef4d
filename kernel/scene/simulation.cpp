#include "scene/simulation.h"

#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace diatom {

namespace {

/// Cell-steps of one batch, and steps at least: a look at the energies takes as long as some tens of steps.
/// Fixed, so that energies are looked at after the same steps on every machine.
constexpr std::int64_t kBatch = 5'000'000, kBatchSteps = 1000;

} // namespace

struct Simulation::Self
{
   std::unique_ptr<SolverRun> run;
   double askedStep = 0; // 0 = the solver's own
   double step = 0, goal = 0;
   std::int64_t steps = 0;
   Energy atStart;
   double mostInPlay = 0;

   Result<Energy> energyNow(const Job &job) const;
   Status lookAtEnergy(const Job &job);
   Error diverged(const diatom_step_result &result) const;
};

Result<Energy> Simulation::Self::energyNow(const Job &job) const
{
   const auto row = run->read("energy", 0, 1, job);
   if (!row)
      return row.error();
   if (row->size() < 6)
      return Error{ErrorCode::internal,
                   fmt::format("{}: its output 'energy' must have 6 numbers", run->solver())};
   return Energy{(*row)[0], (*row)[1], (*row)[2], (*row)[3], (*row)[4], (*row)[5], 0};
}

Status Simulation::Self::lookAtEnergy(const Job &job)
{
   const auto now = energyNow(job);
   if (!now)
      return now.error();
   mostInPlay = std::max(mostInPlay, now->kinetic + now->elastic + now->contact +
                                         std::abs(now->gravity - atStart.gravity));
   return {};
}

Error Simulation::Self::diverged(const diatom_step_result &result) const
{
   const double stableStep = run->estimate().stable_step;
   const std::string remedy =
       stableStep > 0 && step > stableStep
           ? fmt::format("the step of {} s is above the largest stable one, {} s: use --step auto",
                         numberText(step), numberText(stableStep))
           : fmt::format("halve the step of {} s or add damping", numberText(step));
   return {ErrorCode::unstable, fmt::format("the simulation diverged after t = {} s {}; {}",
                                            numberText(result.time), run->placeOf(result), remedy)};
}

Simulation::Simulation() : m_self(std::make_unique<Self>()) {}
Simulation::~Simulation() = default;

Result<std::unique_ptr<Simulation>> Simulation::start(std::shared_ptr<const Catalogue> catalogue,
                                                      std::unique_ptr<Scene> scene, const Setup &setup,
                                                      const Values &values, const Job &job)
{
   if (scene->analysis() != Analysis::dynamics)
      return Error{ErrorCode::internal, "the scene was built for another analysis than dynamics"};
   auto run = SolverRun::create(std::move(catalogue), std::move(scene), setup, values, job);
   if (!run)
      return run.error();
   std::unique_ptr<Simulation> simulation(new Simulation);
   Self &self = *simulation->m_self;
   self.run = *std::move(run);
   self.askedStep = setup.step;
   self.step = setup.step > 0 ? setup.step : self.run->estimate().stable_step;
   const auto energy = self.energyNow(job);
   if (!energy)
      return energy.error();
   self.atStart = *energy;
   if (const Status looked = self.lookAtEnergy(job); !looked)
      return looked.error();
   return simulation;
}

const SolverRun &Simulation::run() const { return *m_self->run; }
const Scene &Simulation::scene() const { return m_self->run->scene(); }
double Simulation::time() const { return m_self->run->time(); }
std::int64_t Simulation::steps() const { return m_self->steps; }
double Simulation::step() const { return m_self->step; }
double Simulation::stableStep() const { return m_self->run->estimate().stable_step; }
std::int64_t Simulation::stableLink() const { return m_self->run->estimate().stable_link; }
double Simulation::wallSeconds() const { return m_self->run->wallSeconds(); }

void Simulation::setGoal(double time) { m_self->goal = time; }

Status Simulation::advance(double until, const Job &job, std::int64_t most)
{
   Self &self = *m_self;
   SolverRun &run = *self.run;
   const std::int64_t batch = std::max(kBatchSteps, kBatch / run.scene().cells());
   const std::int64_t last = most > 0 ? self.steps + most : std::numeric_limits<std::int64_t>::max();
   while (run.time() < until && self.steps < last) {
      if (job.cancelled())
         return Error{ErrorCode::cancelled, fmt::format("cancelled at t = {} s", numberText(run.time()))};
      const diatom_step_request request{sizeof(diatom_step_request), until, self.askedStep,
                                        std::min(batch, last - self.steps), 0};
      diatom_step_result result{
          sizeof(diatom_step_result), DIATOM_RUNNING, 0, run.time(), self.step, -1, -1, 0, 0};
      const Status stepped = run.step(request, result, job);
      if (!stepped && stepped.error().code != ErrorCode::cancelled)
         return stepped.error();
      self.steps += result.steps;
      if (result.step > 0)
         self.step = result.step;
      if (!stepped)
         return Error{ErrorCode::cancelled, fmt::format("cancelled at t = {} s", numberText(run.time()))};
      if (result.state == DIATOM_DIVERGED)
         return self.diverged(result);
      if (Status looked = self.lookAtEnergy(job); !looked)
         return looked;
      job.progress(std::min(1.0, run.time() / std::max(until, self.goal)), "simulating");
      if (result.state == DIATOM_DONE)
         break;
      if (result.steps <= 0)
         return Error{ErrorCode::internal, fmt::format("{} stopped stepping at t = {} s without saying why",
                                                       run.solver(), numberText(run.time()))};
   }
   return {};
}

Result<Energy> Simulation::energy(const Job &job) const
{
   auto now = m_self->energyNow(job);
   if (!now)
      return now;
   const auto stored = [](const Energy &e) { return e.kinetic + e.elastic + e.gravity + e.contact; };
   const double missing = stored(*now) + now->dissipated - now->work - stored(m_self->atStart);
   now->drift = m_self->mostInPlay > 0 ? missing / m_self->mostInPlay : 0;
   return now;
}

Result<Momentum> Simulation::momentum(const Job &job) const
{
   const auto row = m_self->run->read("momentum", 0, 1, job);
   if (!row)
      return row.error();
   if (row->size() < 6)
      return Error{ErrorCode::internal,
                   fmt::format("{}: its output 'momentum' must have 6 numbers", m_self->run->solver())};
   return Momentum{Vec3((*row)[0], (*row)[1], (*row)[2]), Vec3((*row)[3], (*row)[4], (*row)[5])};
}

Result<std::vector<double>> Simulation::output(const std::string &name, const Job &job) const
{
   return m_self->run->output(name, job);
}

Result<Frame> Simulation::frame(const Job &job) const { return m_self->run->frame(job); }

Result<double> Simulation::probe(std::int64_t cell, const std::string &channel, const Job &job) const
{
   return m_self->run->probe(cell, channel, job);
}

std::vector<std::pair<std::string, std::string>> Simulation::probeChannels()
{
   return SolverRun::probeChannels();
}

} // namespace diatom
