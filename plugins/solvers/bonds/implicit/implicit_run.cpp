#include "implicit/implicit_run.h"

#include "model/energy.h"
#include "model/stable_step.h"
#include "solid/couplings.h"

#include <charconv>
#include <cmath>

namespace bonds {

using sdk::Failure;

namespace {

/// Energy from nowhere, over all that went in so far, that ends a run.
constexpr double kEnergyGrowth = 4;
constexpr std::int64_t kLookEvery = 16; // steps

std::string text(double value)
{
   char buffer[32];
   const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 4).ptr;
   return {buffer, end};
}

ImplicitOptions optionsFrom(const sdk::Values &values)
{
   ImplicitOptions out{values.number("numerical_damping"), values.number("step_tolerance")};
   if (!(out.numericalDamping >= 0 && out.numericalDamping <= 1))
      throw Failure(DIATOM_BAD_INPUT, "numerical_damping must lie between 0 and 1");
   if (!(out.tolerance > 0 && out.tolerance <= 1))
      throw Failure(DIATOM_BAD_INPUT, "step_tolerance must lie between 0 and 1, and above 0");
   return out;
}

State startOf(const sdk::SceneView &scene, const Balance &balance)
{
   State state(scene.cells());
   startPose(scene, state);
   const auto &velocity = balance.assembly().velocity;
   for (std::int64_t i = 0; i < static_cast<std::int64_t>(velocity.size()); ++i)
      for (int k = 0; k < 6; ++k)
         state.column(7 + k)[i] = balance.supports().held(i, k) ? 0 : velocity[i][k];
   return state;
}

/// A step that is right for anything: chosen steps grow from there.
double firstStep(const Balance &balance)
{
   return stableStep(balance.assembly(), {}, balance.couplings()).step;
}

} // namespace

void ImplicitRun::estimate(const Options &options, const sdk::SceneView &scene, diatom_estimate &estimate)
{
   const Assembly assembly(scene, options);
   const auto cells = static_cast<double>(assembly.cells), links = static_cast<double>(assembly.links);
   estimate.bytes = cells * 3e3 + links * 1.9e3;
   estimate.step_seconds = cells * 1.2e-5;
   estimate.stable_step = 0;
   estimate.stable_link = -1;
}

ImplicitRun::ImplicitRun(const Options &options, const sdk::Values &values, const sdk::SceneView &scene)
    : m_balance(scene, options),
      m_motion(m_balance, optionsFrom(values), firstStep(m_balance), startOf(scene, m_balance)),
      m_readout(m_balance, {{"effort", "", 1, 6}}), m_good(m_motion.moment())
{
   if (m_balance.assembly().law == Law::small)
      throw Failure(
          DIATOM_UNSUPPORTED,
          "implicit steps always follow rotation: leave the effect on, or choose another integrator");
   if (!options.exact)
      throw Failure(DIATOM_UNSUPPORTED, "implicit steps need the exact gradient: leave gradient at exact");
   if (options.precision == Options::Precision::f32)
      throw Failure(DIATOM_UNSUPPORTED,
                    "there is no single precision for implicit steps: choose the precision f64");
   const auto e = m_motion.energy();
   m_start = e[0] + e[1] + e[2] + e[3];
   const Assembly &assembly = m_balance.assembly();
   double stiffest = 0;
   for (std::int64_t i = 0; i < assembly.links; ++i)
      stiffest = std::max(stiffest, assembly.constants[i].k[0] * assembly.lengthOf(i) * assembly.lengthOf(i));
   m_scale = e[0] + e[1] + e[3] + 1e-9 * stiffest; // 5e-5 strain in one bond is no growth
}

void ImplicitRun::apply(const sdk::Call &call, std::span<const diatom_channel> channels)
{
   m_motion.apply(call, channels);
}

/// Whether energy has come from nowhere, or is none.
bool ImplicitRun::grown()
{
   const auto e = m_motion.energy();
   const double balance = e[0] + e[1] + e[2] + e[3] + e[4] - e[5] - m_start;
   m_most = std::max(m_most, std::abs(e[2]) + std::abs(e[5]));
   return !std::isfinite(balance) || balance > kEnergyGrowth * (m_scale + m_most);
}

void ImplicitRun::reportFailure(const sdk::Call &call, double step, diatom_step_result &result)
{
   m_failed = true;
   result.state = DIATOM_DIVERGED;
   const Assembly &assembly = m_balance.assembly();
   const State &state = m_motion.motion().state;
   const RestShape &rest = m_motion.loading().rest;
   result.bad_cell = brokenCell(assembly, state);
   const std::int64_t bond = worstBond(assembly, state, rest.d[0].empty() ? nullptr : &rest);
   result.bad_link = bond < 0 ? -1 : assembly.link[bond];
   if (grown())
      m_motion.goBack(m_good);
   result.time = m_motion.motion().time;
   call.report(DIATOM_ERROR,
               "no motion was found beyond " + text(m_motion.motion().time) + " s in steps of " + text(step) +
                   " s or shorter, and the last good state is kept: use a shorter step, --step auto, or more "
                   "numerical_damping");
}

ImplicitMotion::End ImplicitRun::advance(const sdk::Call &call, const diatom_step_request &request,
                                         double step)
{
   return step > 0 ? m_motion.by(call, step) : m_motion.towards(call, request.until);
}

std::int32_t ImplicitRun::step(const sdk::Call &call, const diatom_step_request &request,
                               diatom_step_result &result)
{
   const double start = m_motion.motion().time, span = request.until - start;
   result.steps = result.iterations = 0;
   result.residual = 0;
   result.bad_cell = result.bad_link = -1;
   result.state = m_failed ? DIATOM_DIVERGED : DIATOM_RUNNING;
   result.time = start;
   result.step = request.step;
   if (!std::isfinite(request.until))
      throw Failure(DIATOM_BAD_INPUT, "the time to simulate until must be a number");
   if (!(request.step >= 0) || std::isinf(request.step))
      throw Failure(DIATOM_BAD_INPUT,
                    "the step must be a positive number of seconds, or 0 for one that follows the motion");
   if (m_failed)
      return DIATOM_OK;
   if (!(span > 0)) {
      result.state = DIATOM_DONE;
      return DIATOM_OK;
   }
   // Whole steps of equal length that end exactly at `until`, or as many as it takes.
   const bool chosen = request.step == 0;
   const double wanted = chosen ? 0 : std::max(1.0, std::ceil(span / request.step * (1 - 1e-12)));
   const double dt = chosen ? 0 : span / wanted;
   const std::int64_t before = m_motion.effort().iterations;
   for (std::int64_t n = 0; m_motion.motion().time < request.until; ++n) {
      if (request.max_steps > 0 && n == request.max_steps)
         break;
      const double left = request.until - m_motion.motion().time;
      const bool last = !chosen && left < 1.5 * dt;
      const ImplicitMotion::End end = advance(call, request, last ? left : dt);
      result.time = m_motion.motion().time;
      result.iterations = m_motion.effort().iterations - before;
      if (end == ImplicitMotion::End::cancelled) {
         m_motion.settle(call);
         return DIATOM_CANCELLED;
      }
      const bool look = n % kLookEvery == 0;
      if (end == ImplicitMotion::End::failed || (look && grown())) {
         reportFailure(call, chosen ? m_motion.motion().step : dt, result);
         return DIATOM_OK;
      }
      if (look)
         m_good = m_motion.moment();
      ++result.steps;
      result.step = m_motion.motion().step;
      if (n % kLookEvery == 0)
         call.progress((m_motion.motion().time - start) / span, "stepping");
   }
   m_motion.settle(call);
   if (m_motion.motion().time >= request.until)
      result.state = DIATOM_DONE;
   return DIATOM_OK;
}

void ImplicitRun::read(std::int64_t output, std::int64_t first, std::int64_t count, double *values) const
{
   if (output == Readout::kShared) {
      const Effort effort = m_motion.effort();
      const double all[6] = {static_cast<double>(effort.steps),
                             static_cast<double>(effort.iterations),
                             static_cast<double>(effort.factorisations),
                             static_cast<double>(effort.repeated),
                             effort.shortest,
                             effort.longest};
      std::copy_n(all, count == 1 ? 6 : 0, values);
      return;
   }
   const Vector reaction = m_motion.reaction();
   Reading reading{m_motion.motion().state, m_motion.loading(), m_motion.internal(), reaction, {}};
   if (output == Readout::kEnergy)
      reading.energy = m_motion.energy();
   m_readout.read(reading, output, first, count, values);
}

} // namespace bonds
