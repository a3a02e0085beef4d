#include "scene/simulation.h"

#include "core/text.h"
#include "scene/problems.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>

namespace diatom {

namespace {

constexpr const char *kInterface = DIATOM_SOLVER_1;
/// Cell-steps of one batch: about 50 ms at 100 ns each. Fixed, so that energies are looked at after the same
/// steps on every machine.
constexpr std::int64_t kBatch = 500'000;

/// What a solver says it can do, copied out of its memory.
struct Capabilities
{
   std::vector<std::string> analyses, effects, lattices;
};

std::vector<std::string> copied(std::int64_t count, const char *const *names)
{
   return count > 0 && names ? std::vector<std::string>(names, names + count) : std::vector<std::string>();
}

bool contains(const std::vector<std::string> &list, std::string_view name)
{
   return std::find(list.begin(), list.end(), name) != list.end();
}

const diatom_solver *solverTable(const void *table) { return static_cast<const diatom_solver *>(table); }

Result<Capabilities> readCapabilities(const Catalogue &catalogue, const std::string &id, const Values &values,
                                      const Job &job)
{
   Capabilities found;
   const Status read = catalogue.callWith(
       kInterface, id, values, "capabilities", job,
       [&](const void *table, const diatom_call *call, const diatom_create *create) -> std::int32_t {
          const diatom_capabilities *caps = nullptr;
          const std::int32_t status = solverTable(table)->capabilities(call, create->id, &caps);
          if (status != DIATOM_OK)
             return status;
          if (!caps)
             return DIATOM_INTERNAL;
          found.analyses = copied(caps->analyses, caps->analysis_name);
          found.effects = copied(caps->effects, caps->effect_name);
          found.lattices = copied(caps->lattices, caps->lattice);
          return DIATOM_OK;
       });
   if (!read)
      return read.error();
   return found;
}

/// No solver ignores physics in silence: whatever the scene calls for must be among what it can do.
Status checkCapabilities(const Capabilities &can, const Scene &scene, const Setup &setup)
{
   if (!contains(can.analyses, "dynamics"))
      return Error{ErrorCode::unsupported,
                   fmt::format("{} cannot simulate motion in time; choose another solver", setup.solver)};
   for (const Effect &effect : scene.effects()) {
      const auto asked = setup.effects.find(effect.name);
      if (!effect.on && asked != setup.effects.end() && asked->second)
         return Error{ErrorCode::unsupported,
                      fmt::format("the effect '{}' cannot be switched on: {}", effect.name, effect.why)};
      if (effect.on && effectIsForSolver(effect.name) && !contains(can.effects, effect.name))
         return Error{
             ErrorCode::unsupported,
             fmt::format("the scene calls for '{}' ({}), which {} cannot do; choose another solver or "
                         "switch the effect off with --effects -{}",
                         effect.name, effect.why, setup.solver, effect.name)};
   }
   return {};
}

struct ProbeChannel
{
   const char *name, *unit, *output;
   int component;
};

constexpr std::array<ProbeChannel, 10> kProbeChannels{{{"x", "m", "position", 0},
                                                       {"y", "m", "position", 1},
                                                       {"z", "m", "position", 2},
                                                       {"vx", "m/s", "velocity", 0},
                                                       {"vy", "m/s", "velocity", 1},
                                                       {"vz", "m/s", "velocity", 2},
                                                       {"rx", "rad", "rotation", 0},
                                                       {"ry", "rad", "rotation", 1},
                                                       {"rz", "rad", "rotation", 2},
                                                       {"strain", "", "strain", 0}}};

/// Rotation vector of a quaternion w x y z, exact for small turns as well.
Vec3 rotationVector(const double *wxyz)
{
   const double sign = wxyz[0] < 0 ? -1 : 1;
   const Vec3 v = sign * Vec3(wxyz[1], wxyz[2], wxyz[3]);
   const double sine = v.norm();
   const double scale = sine < 1e-12 ? 2.0 : 2 * std::atan2(sine, sign * wxyz[0]) / sine;
   return scale * v;
}

} // namespace

struct Simulation::Self
{
   std::shared_ptr<const Catalogue> catalogue;
   std::unique_ptr<Scene> scene;
   std::shared_ptr<const Instance> solver;
   std::map<std::string, diatom_output> outputs; // by name; the number within the solver is in outputNumber
   std::map<std::string, std::int64_t> outputNumber;

   double askedStep = 0; // 0 = the solver's own
   double time = 0, step = 0, stableStep = 0, wall = 0, goal = 0;
   std::int64_t steps = 0, stableLink = -1;
   Energy atStart;
   double mostInPlay = 0;

   const diatom_solver *table() const { return solver->table<diatom_solver>(); }
   Status listOutputs(const Job &job);
   Result<std::vector<double>> read(const std::string &name, std::int64_t first, std::int64_t count,
                                    const Job &job) const;
   Result<Energy> energyNow(const Job &job) const;
   Status lookAtEnergy(const Job &job);
   Error diverged(const diatom_step_result &result) const;
};

Status Simulation::Self::listOutputs(const Job &job)
{
   return solver->call("outputs", job, [&](const diatom_call *call) -> std::int32_t {
      const diatom_outputs *list = nullptr;
      const std::int32_t status = table()->outputs(solver->self(), call, &list);
      if (status != DIATOM_OK || !list)
         return status != DIATOM_OK ? status : DIATOM_INTERNAL;
      for (std::int64_t k = 0; k < list->count; ++k) {
         outputs[list->output[k].name] = list->output[k];
         outputNumber[list->output[k].name] = k;
      }
      return DIATOM_OK;
   });
}

Result<std::vector<double>> Simulation::Self::read(const std::string &name, std::int64_t first,
                                                   std::int64_t count, const Job &job) const
{
   const auto found = outputs.find(name);
   if (found == outputs.end())
      return Error{ErrorCode::unsupported, fmt::format("{} has no output '{}'", solver->id(), name)};
   if (first < 0 || count < 0 || first + count > found->second.count)
      return Error{ErrorCode::internal, fmt::format("{} has {} rows of '{}', not {}", solver->id(),
                                                    found->second.count, name, first + count)};
   std::vector<double> values(static_cast<std::size_t>(count * found->second.stride));
   const Status done = solver->call("read", job, [&](const diatom_call *call) {
      return table()->read(solver->self(), call, outputNumber.at(name), first, count, values.data());
   });
   if (!done)
      return done.error();
   return values;
}

Result<Energy> Simulation::Self::energyNow(const Job &job) const
{
   const auto row = read("energy", 0, 1, job);
   if (!row)
      return row.error();
   if (row->size() < 6)
      return Error{ErrorCode::internal,
                   fmt::format("{}: its output 'energy' must have 6 numbers", solver->id())};
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
   std::string where = "somewhere";
   const diatom_scene &view = scene->view();
   const auto index = [&](std::int64_t cell) {
      return indexText(scene->indices()[static_cast<std::size_t>(cell)]);
   };
   if (result.bad_link >= 0 && result.bad_link < view.links)
      where = fmt::format("in the bond between cells {} and {}", index(view.link_a[result.bad_link]),
                          index(view.link_b[result.bad_link]));
   else if (result.bad_cell >= 0 && result.bad_cell < view.cells)
      where = fmt::format("at cell {}", index(result.bad_cell));
   const std::string remedy =
       stableStep > 0 && step > stableStep
           ? fmt::format("the step of {} s is above the largest stable one, {} s: use --step auto",
                         numberText(step), numberText(stableStep))
           : fmt::format("halve the step of {} s or add damping", numberText(step));
   return {ErrorCode::unstable, fmt::format("the simulation diverged after t = {} s {}; {}",
                                            numberText(result.time), where, remedy)};
}

Simulation::Simulation() : m_self(std::make_unique<Self>()) {}
Simulation::~Simulation() = default;

Result<std::unique_ptr<Simulation>> Simulation::start(std::shared_ptr<const Catalogue> catalogue,
                                                      std::unique_ptr<Scene> scene, const Setup &setup,
                                                      const Values &values, const Job &job)
{
   Values merged = setup.solverValues;
   for (const auto &[name, value] : values)
      merged[name] = value;
   const auto can = readCapabilities(*catalogue, setup.solver, merged, job);
   if (!can)
      return can.error();
   if (const Status able = checkCapabilities(*can, *scene, setup); !able)
      return able.error();

   std::unique_ptr<Simulation> simulation(new Simulation);
   Self &self = *simulation->m_self;
   diatom_estimate estimate{};
   estimate.size = sizeof estimate;
   estimate.stable_link = -1;
   const Status estimated =
       catalogue->callWith(kInterface, setup.solver, merged, "estimate", job,
                           [&](const void *table, const diatom_call *call, const diatom_create *create) {
                              return solverTable(table)->estimate(call, create, &scene->view(), &estimate);
                           });
   if (!estimated)
      return estimated.error();
   const auto solver = catalogue->createWith(
       kInterface, setup.solver, merged, job,
       [&](const void *table, const diatom_call *call, const diatom_create *create, void **made) {
          return solverTable(table)->create(call, create, &scene->view(), made);
       },
       [](const void *table) { return solverTable(table)->destroy; });
   if (!solver)
      return solver.error();
   self.catalogue = std::move(catalogue);
   self.scene = std::move(scene);
   self.solver = *solver;
   self.askedStep = setup.step;
   self.stableStep = estimate.stable_step;
   self.stableLink = estimate.stable_link;
   self.step = setup.step > 0 ? setup.step : estimate.stable_step;
   if (const Status listed = self.listOutputs(job); !listed)
      return listed.error();
   const auto energy = self.energyNow(job);
   if (!energy)
      return energy.error();
   self.atStart = *energy;
   if (const Status looked = self.lookAtEnergy(job); !looked)
      return looked.error();
   return simulation;
}

const Scene &Simulation::scene() const { return *m_self->scene; }
double Simulation::time() const { return m_self->time; }
std::int64_t Simulation::steps() const { return m_self->steps; }
double Simulation::step() const { return m_self->step; }
double Simulation::stableStep() const { return m_self->stableStep; }
std::int64_t Simulation::stableLink() const { return m_self->stableLink; }
double Simulation::wallSeconds() const { return m_self->wall; }

void Simulation::setGoal(double time) { m_self->goal = time; }

Status Simulation::advance(double until, const Job &job)
{
   using Clock = std::chrono::steady_clock;
   Self &self = *m_self;
   const std::int64_t batch = std::max<std::int64_t>(1, kBatch / self.scene->cells());
   while (self.time < until) {
      if (job.cancelled())
         return Error{ErrorCode::cancelled, fmt::format("cancelled at t = {} s", numberText(self.time))};
      const diatom_step_request request{sizeof(diatom_step_request), until, self.askedStep, batch, 0};
      diatom_step_result result{
          sizeof(diatom_step_result), DIATOM_RUNNING, 0, self.time, self.step, -1, -1, 0, 0};
      const auto before = Clock::now();
      const Status stepped = self.solver->call("step", job, [&](const diatom_call *call) {
         return self.table()->step(self.solver->self(), call, &request, &result);
      });
      self.wall += std::chrono::duration<double>(Clock::now() - before).count();
      if (!stepped && stepped.error().code != ErrorCode::cancelled)
         return stepped.error();
      self.steps += result.steps;
      self.time = result.time;
      if (result.step > 0)
         self.step = result.step;
      if (!stepped)
         return Error{ErrorCode::cancelled, fmt::format("cancelled at t = {} s", numberText(self.time))};
      if (result.state == DIATOM_DIVERGED)
         return self.diverged(result);
      if (const Status looked = self.lookAtEnergy(job); !looked)
         return looked;
      job.progress(std::min(1.0, self.time / std::max(until, self.goal)), "simulating");
      if (result.state == DIATOM_DONE)
         break;
      if (result.steps <= 0)
         return Error{ErrorCode::internal, fmt::format("{} stopped stepping at t = {} s without saying why",
                                                       self.solver->id(), numberText(self.time))};
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
   const auto row = m_self->read("momentum", 0, 1, job);
   if (!row)
      return row.error();
   if (row->size() < 6)
      return Error{ErrorCode::internal,
                   fmt::format("{}: its output 'momentum' must have 6 numbers", m_self->solver->id())};
   return Momentum{Vec3((*row)[0], (*row)[1], (*row)[2]), Vec3((*row)[3], (*row)[4], (*row)[5])};
}

Result<std::vector<double>> Simulation::output(const std::string &name, const Job &job) const
{
   const auto found = m_self->outputs.find(name);
   return m_self->read(name, 0, found == m_self->outputs.end() ? 0 : found->second.count, job);
}

Result<Frame> Simulation::frame(const Job &job) const
{
   auto position = output("position", job);
   if (!position)
      return position.error();
   auto rotation = output("rotation", job);
   if (!rotation)
      return rotation.error();
   return Frame{m_self->time, *std::move(position), *std::move(rotation)};
}

Result<double> Simulation::probe(std::int64_t cell, const std::string &channel, const Job &job) const
{
   const auto known = std::find_if(kProbeChannels.begin(), kProbeChannels.end(),
                                   [&](const ProbeChannel &one) { return channel == one.name; });
   if (known == kProbeChannels.end())
      return Error{ErrorCode::usage,
                   fmt::format("there is no channel '{}' to probe; there are x y z vx vy vz rx "
                               "ry rz strain",
                               channel)};
   if (cell < 0 || cell >= m_self->scene->cells())
      return Error{ErrorCode::usage, "there is no cell to probe there"};
   const auto row = m_self->read(known->output, cell, 1, job);
   if (!row)
      return row.error();
   if (std::string_view(known->output) == "rotation")
      return rotationVector(row->data())[known->component];
   const double value = (*row)[static_cast<std::size_t>(known->component)];
   if (std::string_view(known->output) == "position")
      return value - m_self->scene->view().cell_position[3 * cell + known->component];
   return value;
}

std::vector<std::pair<std::string, std::string>> Simulation::probeChannels()
{
   std::vector<std::pair<std::string, std::string>> channels;
   for (const ProbeChannel &channel : kProbeChannels)
      channels.emplace_back(channel.name, channel.unit);
   return channels;
}

} // namespace diatom
