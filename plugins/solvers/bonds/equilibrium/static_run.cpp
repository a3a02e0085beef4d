#include "equilibrium/static_run.h"

#include "equilibrium/rigid_motion.h"
#include "model/large_turns.h"

#include <charconv>
#include <cmath>

namespace bonds {

using sdk::Failure;

namespace {

constexpr double kDefaultTolerance = 1e-9;

std::string text(double value)
{
   char buffer[32];
   const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 4).ptr;
   return {buffer, end};
}

State startOf(const sdk::SceneView &scene, const Assembly &assembly)
{
   State state(assembly.cells, assembly.law);
   startPose(scene, state);
   return state;
}

double storedIn(const Balance &balance, const State &state, const Loading &loading)
{
   return balance.elasticEnergy(state, loading.rest) + balance.gravityEnergy(state) +
          balance.contactEnergy(state);
}

} // namespace

void StaticRun::estimate(const Options &options, const sdk::SceneView &scene, diatom_estimate &estimate)
{
   const Assembly assembly(scene, options);
   const auto cells = static_cast<double>(assembly.cells), links = static_cast<double>(assembly.links);
   // Of dense blocks of 20^3 to 40^3 cells that sag: 8 kB and 40 to 65 us a cell on a 2020s core.
   estimate.bytes = cells * 2.5e3 + links * 1.9e3;
   estimate.step_seconds = cells * 6e-5;
   estimate.stable_step = 0;
   estimate.stable_link = -1;
}

StaticRun::StaticRun(const Options &options, const sdk::Values &values, const sdk::SceneView &scene)
    : m_balance(scene, options), m_state(startOf(scene, m_balance.assembly())),
      m_statics(m_balance, m_balance.unloaded(m_state)), m_readout(m_balance, {})
{
   m_options.steps = static_cast<int>(values.number("load_steps"));
   m_internal = m_reaction = Vector::Zero(6 * m_state.n);
   m_storedAtStart = storedIn(m_balance, m_state, m_statics.loading());
   if (m_balance.assembly().hasFriction)
      throw Failure(
          DIATOM_UNSUPPORTED,
          "where friction holds depends on how the cells came there, which a static balance does not "
          "follow: hold the cells that stick, switch friction off, or simulate in time");
}

void StaticRun::apply(const sdk::Call &, std::span<const diatom_channel> channels)
{
   m_balance.apply(channels);
}

std::string StaticRun::failureText(const StaticsResult &result) const
{
   const std::string after = text(100 * result.reached) + " % of the loads";
   if (result.freedom >= 0)
      return "nothing resists that the cell " + m_balance.name(result.freedom / 6) + " should " +
             freedomText(static_cast<int>(result.freedom % 6)) + ", after " + after +
             ": give its material the stiffness that is missing, or hold it";
   return "the balance is lost beyond " + after + ", first at the cell " + m_balance.name(result.cell) +
          ", and the last one is kept: the loads may be more than the shape can carry (a limit point); lower "
          "them, drive a displacement instead, or simulate in time";
}

void StaticRun::takeForces(const sdk::Call &call)
{
   Measure measure;
   Vector external;
   m_balance.internal(call, m_state, m_statics.loading(), false, m_internal, measure);
   m_balance.external(m_state, m_statics.loading(), external, measure);
   m_reaction = reactionOf(m_balance.supports(), m_internal + external);
}

bool StaticRun::inBalance(const sdk::Call &call, const diatom_step_request &request,
                          diatom_step_result &result)
{
   if (!std::isfinite(request.until))
      throw Failure(DIATOM_BAD_INPUT, "the time of the balance must be a number");
   const Measure measure = m_statics.measureAt(call, m_balance.loadingAt(request.until), m_state);
   if (!measure.within(request.tolerance > 0 ? request.tolerance : kDefaultTolerance))
      return false;
   takeForces(call);
   result.state = DIATOM_CONVERGED;
   result.steps = 1;
   result.iterations = 0;
   result.residual = 0;
   result.step = 0;
   result.bad_cell = result.bad_link = -1;
   result.time = m_time = request.until;
   return true;
}

std::int32_t StaticRun::step(const sdk::Call &call, const diatom_step_request &request,
                             diatom_step_result &result)
{
   if (!std::isfinite(request.until))
      throw Failure(DIATOM_BAD_INPUT, "the time of the balance must be a number");
   refuseLoose(m_balance, m_state);
   m_options.tolerance = request.tolerance > 0 ? request.tolerance : kDefaultTolerance;
   const StaticsResult found = m_statics.solve(call, m_balance.loadingAt(request.until), m_options, m_state);
   takeForces(call);
   result.steps = found.balanced ? 1 : 0;
   result.step = 0;
   result.iterations = found.iterations;
   result.residual = found.residual;
   result.bad_cell = result.bad_link = -1;
   result.time = m_time = found.balanced ? request.until : m_time;
   if (found.cancelled)
      return DIATOM_CANCELLED;
   result.state = found.balanced ? DIATOM_CONVERGED : DIATOM_DIVERGED;
   if (!found.balanced) {
      result.bad_cell = found.freedom >= 0 ? found.freedom / 6 : found.cell;
      call.report(DIATOM_ERROR, failureText(found));
   } else if (found.negative > 0) {
      call.report(DIATOM_WARNING, "this balance is unstable in " + std::to_string(found.negative) +
                                      (found.negative == 1 ? " direction" : " directions") +
                                      ": the least disturbance leads away from it");
   }
   const Assembly &assembly = m_balance.assembly();
   const auto name = [&](std::int64_t bond) {
      return "the bond of cells " + m_balance.name(assembly.a[bond]) + " and " +
             m_balance.name(assembly.b[bond]);
   };
   if (const auto warning = largeTurnsIn(assembly, m_state, name))
      call.report(DIATOM_WARNING, *warning);
   return DIATOM_OK;
}

void StaticRun::read(std::int64_t output, std::int64_t first, std::int64_t count, double *values) const
{
   const Loading &loading = m_statics.loading();
   Reading reading{m_state, loading, m_internal, m_reaction, {}};
   if (output == Readout::kEnergy) {
      // Loads, signals and curves did, slowly, all the work that is stored.
      const double elastic = m_balance.elasticEnergy(m_state, loading.rest),
                   gravity = m_balance.gravityEnergy(m_state), contact = m_balance.contactEnergy(m_state);
      reading.energy = {0, elastic, gravity, contact, 0, elastic + gravity + contact - m_storedAtStart};
   }
   m_readout.read(reading, output, first, count, values);
}

} // namespace bonds
