#include "scene/solver_run.h"

#include "core/clock.h"
#include "core/text.h"
#include "scene/problems.h"
#include "scene/solver_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace diatom {

namespace {

constexpr const char *kInterface = DIATOM_SOLVER_1;

/// What a solver says it can do, copied out of its memory.
struct Capabilities
{
   std::vector<std::string> physics, analyses, effects, lattices;
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

/// Asked without values, so that what a solver cannot do at all is told before values that it does not know.
Result<Capabilities> readCapabilities(const Catalogue &catalogue, const std::string &id, const Job &job)
{
   Capabilities found;
   const Status read = catalogue.callWith(
       kInterface, id, {}, "capabilities", job,
       [&](const void *table, const diatom_call *call, const diatom_create *create) -> std::int32_t {
          const diatom_capabilities *caps = nullptr;
          const std::int32_t status = solverTable(table)->capabilities(call, create->id, &caps);
          if (status != DIATOM_OK)
             return status;
          if (!caps)
             return DIATOM_INTERNAL;
          found.physics = copied(caps->physics, caps->physics_name);
          found.analyses = copied(caps->analyses, caps->analysis_name);
          found.effects = copied(caps->effects, caps->effect_name);
          found.lattices = copied(caps->lattices, caps->lattice);
          return DIATOM_OK;
       });
   if (!read)
      return read.error();
   return found;
}

const char *taskOf(Analysis analysis)
{
   switch (analysis) {
   case Analysis::dynamics:
      return "simulate motion in time";
   case Analysis::statics:
      return "find a static balance";
   case Analysis::modes:
      return "find modes of vibration";
   }
   return "do what is asked";
}

/// No solver ignores physics in silence: whatever the scene calls for must be among what it can do.
Status checkCapabilities(const Capabilities &can, const Scene &scene, const Setup &setup)
{
   if (!contains(can.analyses, analysisName(scene.analysis())))
      return Error{ErrorCode::unsupported, fmt::format("{} cannot {}; choose another solver", setup.solver,
                                                       taskOf(scene.analysis()))};
   const bool mechanics = contains(can.physics, kMechanics);
   for (const Effect &effect : scene.effects()) {
      if (!mechanics && effectIsMechanical(effect.name))
         continue; // weights and forces are nothing to a solver of heat
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

constexpr std::array<ProbeChannel, 16> kProbeChannels{{{"x", "m", "position", 0},
                                                       {"y", "m", "position", 1},
                                                       {"z", "m", "position", 2},
                                                       {"vx", "m/s", "velocity", 0},
                                                       {"vy", "m/s", "velocity", 1},
                                                       {"vz", "m/s", "velocity", 2},
                                                       {"rx", "rad", "rotation", 0},
                                                       {"ry", "rad", "rotation", 1},
                                                       {"rz", "rad", "rotation", 2},
                                                       {"strain", "", "strain", 0},
                                                       {"fx", "N", "reaction", 0},
                                                       {"fy", "N", "reaction", 1},
                                                       {"fz", "N", "reaction", 2},
                                                       {"mx", "N m", "reaction", 3},
                                                       {"my", "N m", "reaction", 4},
                                                       {"mz", "N m", "reaction", 5}}};

/// Rotation vector of a quaternion w x y z, exact for small turns as well.
Vec3 rotationVector(const double *wxyz)
{
   const double sign = wxyz[0] < 0 ? -1 : 1;
   const Vec3 v = sign * Vec3(wxyz[1], wxyz[2], wxyz[3]);
   const double sine = v.norm();
   const double scale = sine < 1e-12 ? 2.0 : 2 * std::atan2(sine, sign * wxyz[0]) / sine;
   return scale * v;
}

Result<diatom_estimate> estimateOf(const Catalogue &catalogue, const Scene &scene, const std::string &id,
                                   const Values &values, const Job &job)
{
   diatom_estimate estimate{};
   estimate.size = sizeof estimate;
   estimate.stable_link = -1;
   const Status estimated =
       catalogue.callWith(kInterface, id, values, "estimate", job,
                          [&](const void *table, const diatom_call *call, const diatom_create *create) {
                             return solverTable(table)->estimate(call, create, &scene.view(), &estimate);
                          });
   if (!estimated)
      return estimated.error();
   return estimate;
}

} // namespace

Result<std::vector<std::string>> solverPhysics(const Catalogue &catalogue, const std::string &solver,
                                               const Job &job)
{
   const auto can = readCapabilities(catalogue, solver, job);
   if (!can)
      return can.error();
   return can->physics;
}

Result<std::unique_ptr<SolverRun>> SolverRun::create(std::shared_ptr<const Catalogue> catalogue,
                                                     std::unique_ptr<Scene> scene, const Setup &setup,
                                                     const Values &values, const Job &job)
{
   Values merged = setup.solverValues;
   for (const auto &[name, value] : values)
      merged[name] = value;
   const auto can = readCapabilities(*catalogue, setup.solver, job);
   if (!can)
      return can.error();
   if (const Status able = checkCapabilities(*can, *scene, setup); !able)
      return able.error();
   const auto estimate = estimateOf(*catalogue, *scene, setup.solver, merged, job);
   if (!estimate)
      return estimate.error();
   const auto solver = catalogue->createWith(
       kInterface, setup.solver, merged, job,
       [&](const void *table, const diatom_call *call, const diatom_create *create, void **made) {
          return solverTable(table)->create(call, create, &scene->view(), made);
       },
       [](const void *table) { return solverTable(table)->destroy; });
   if (!solver)
      return solver.error();
   std::unique_ptr<SolverRun> run(new SolverRun);
   run->m_catalogue = std::move(catalogue);
   run->m_scene = std::move(scene);
   run->m_solver = *solver;
   run->m_estimate = *estimate;
   run->m_mechanics = contains(can->physics, kMechanics);
   if (const Status listed = run->listOutputs(job); !listed)
      return listed.error();
   return run;
}

Status SolverRun::listOutputs(const Job &job)
{
   const diatom_outputs *list = nullptr;
   Status listed = m_solver->call("outputs", job, [&](const diatom_call *call) {
      return m_solver->table<diatom_solver>()->outputs(m_solver->self(), call, &list);
   });
   if (!listed)
      return listed;
   const std::string fault = list ? faultOfOutputs(*list, *m_scene) : "it lists no outputs";
   if (!fault.empty())
      return broken("outputs", fault);
   m_outputs.clear();
   for (std::int64_t k = 0; k < list->count; ++k)
      m_outputs[list->output[k].name] = {k, list->output[k].count, list->output[k].stride,
                                         list->output[k].unit ? list->output[k].unit : ""};
   return {};
}

Error SolverRun::broken(const char *function, const std::string &fault) const
{
   return {ErrorCode::internal,
           fmt::format("{} ({}): {}; choose another solver and tell its author", solver(), function, fault)};
}

Status SolverRun::step(const diatom_step_request &request, diatom_step_result &result, const Job &job)
{
   const auto before = Clock::now();
   Status stepped = m_solver->call("step", job, [&](const diatom_call *call) {
      return m_solver->table<diatom_solver>()->step(m_solver->self(), call, &request, &result);
   });
   m_wall += secondsSince(before);
   if (stepped.ok())
      if (const std::string fault = faultOfStep(result); !fault.empty())
         return broken("step", fault);
   m_time = result.time;
   return stepped;
}

std::int64_t SolverRun::rows(const std::string &name) const
{
   const auto found = m_outputs.find(name);
   return found == m_outputs.end() ? 0 : found->second.rows;
}

Result<std::vector<double>> SolverRun::read(const std::string &name, std::int64_t first, std::int64_t count,
                                            const Job &job) const
{
   const auto found = m_outputs.find(name);
   if (found == m_outputs.end())
      return Error{ErrorCode::unsupported, fmt::format("{} has no output '{}'", solver(), name)};
   const Output &output = found->second;
   if (first < 0 || count < 0 || first + count > output.rows)
      return Error{ErrorCode::internal,
                   fmt::format("{} has {} rows of '{}', not {}", solver(), output.rows, name, first + count)};
   std::vector<double> values(static_cast<std::size_t>(count * output.stride));
   const Status done = m_solver->call("read", job, [&](const diatom_call *call) {
      return m_solver->table<diatom_solver>()->read(m_solver->self(), call, output.number, first, count,
                                                    values.data());
   });
   if (!done)
      return done.error();
   if (const std::string fault = faultOfRows(values, name, first, output.stride, output.rows, *m_scene);
       !fault.empty())
      return broken("read", fault);
   return values;
}

std::vector<SolverRun::Told> SolverRun::told() const
{
   std::vector<Told> list;
   for (const auto &[name, output] : m_outputs)
      list.push_back({name, output.unit, output.rows, output.stride});
   std::sort(list.begin(), list.end(), [this](const Told &a, const Told &b) {
      return m_outputs.at(a.name).number < m_outputs.at(b.name).number;
   });
   return list;
}

Result<std::vector<double>> SolverRun::output(const std::string &name, const Job &job) const
{
   return read(name, 0, rows(name), job);
}

Result<Frame> SolverRun::frame(const Job &job) const
{
   auto position = output("position", job);
   if (!position)
      return position.error();
   auto rotation = output("rotation", job);
   if (!rotation)
      return rotation.error();
   return Frame{m_time, *std::move(position), *std::move(rotation)};
}

Result<double> SolverRun::probe(std::int64_t cell, const std::string &channel, const Job &job) const
{
   const auto known = std::find_if(kProbeChannels.begin(), kProbeChannels.end(),
                                   [&](const ProbeChannel &one) { return channel == one.name; });
   if (known == kProbeChannels.end() && cell >= 0 && cell < m_scene->cells()) {
      const std::size_t dot = channel.rfind('.');
      const auto component = dot == std::string::npos
                                 ? std::optional<std::int64_t>(0)
                                 : parseInteger(std::string_view(channel).substr(dot + 1));
      const auto own = m_outputs.find(channel.substr(0, dot));
      if (own != m_outputs.end() && own->second.rows == m_scene->cells() && component && *component >= 0 &&
          *component < own->second.stride)
      {
         const auto row = read(own->first, cell, 1, job);
         return row ? Result<double>((*row)[static_cast<std::size_t>(*component)]) : row.error();
      }
   }
   if (known == kProbeChannels.end()) {
      std::string names;
      for (const ProbeChannel &one : kProbeChannels)
         names += hasOutput(one.output) ? std::string(" ") + one.name : "";
      for (const auto &[name, output] : m_outputs)
         names += !m_mechanics && output.rows == m_scene->cells() ? " " + name : "";
      return Error{ErrorCode::usage,
                   fmt::format("there is no channel '{}' to probe; there are{}", channel, names)};
   }
   if (cell < 0 || cell >= m_scene->cells())
      return Error{ErrorCode::usage, "there is no cell to probe there"};
   const auto row = read(known->output, cell, 1, job);
   if (!row)
      return row.error();
   if (row->size() <= static_cast<std::size_t>(known->component))
      return Error{ErrorCode::internal, fmt::format("{}: its output '{}' has too few numbers for each cell",
                                                    solver(), known->output)};
   if (std::string_view(known->output) == "rotation")
      return rotationVector(row->data())[known->component];
   const double value = (*row)[static_cast<std::size_t>(known->component)];
   if (std::string_view(known->output) == "position")
      return value - m_scene->view().cell_position[3 * cell + known->component];
   return value;
}

std::string SolverRun::placeOf(const diatom_step_result &result) const
{
   const diatom_scene &view = m_scene->view();
   const auto index = [&](std::int64_t cell) {
      return indexText(m_scene->indices()[static_cast<std::size_t>(cell)]);
   };
   if (result.bad_link >= 0 && result.bad_link < view.links)
      return fmt::format("in the bond between cells {} and {}", index(view.link_a[result.bad_link]),
                         index(view.link_b[result.bad_link]));
   if (result.bad_cell >= 0 && result.bad_cell < view.cells)
      return fmt::format("at cell {}", index(result.bad_cell));
   return "somewhere";
}

std::vector<std::pair<std::string, std::string>> SolverRun::probeChannels()
{
   std::vector<std::pair<std::string, std::string>> channels;
   for (const ProbeChannel &channel : kProbeChannels)
      channels.emplace_back(channel.name, channel.unit);
   return channels;
}

} // namespace diatom
