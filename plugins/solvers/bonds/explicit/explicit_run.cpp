#include "explicit/explicit_run.h"

#include "equilibrium/highest_rates.h"
#include "explicit/dynamics.h"
#include "explicit/stages.h"
#include "explicit/vector_motion.h"
#include "model/large_turns.h"
#include "solid/couplings.h"

#include <charconv>
#include <cmath>

namespace bonds {

using sdk::Failure;

namespace {

/// Steps between two looks at energy and finiteness; a diverging run is stopped after at most this many.
constexpr std::int64_t kCheckEvery = 64;
/// Steps between two looks at what is left out of large turns, which takes as long as some ten steps.
constexpr std::int64_t kLookEvery = 1024;
/// Semi-implicit Euler near its limit shows up to 20 times the true energy without growing; beyond this it
/// has diverged.
constexpr double kEnergyGrowth = 40;

std::string text(double value)
{
   char buffer[32];
   const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 4).ptr;
   return {buffer, end};
}

std::vector<std::array<std::int32_t, 3>> indices(const sdk::SceneView &scene)
{
   std::vector<std::array<std::int32_t, 3>> out(static_cast<std::size_t>(scene.cells()));
   for (std::int64_t i = 0; i < scene.cells(); ++i)
      std::copy_n(scene.index(i), 3, out[i].begin());
   return out;
}

std::unique_ptr<Motion> motionFor(const sdk::SceneView &scene, const Assembly &assembly,
                                  const Couplings &couplings, const Options &options)
{
   const bool single = options.precision == Options::Precision::f32;
   if (const auto why = whyNotVector(assembly, couplings, options)) {
      if (single)
         throw Failure(DIATOM_UNSUPPORTED,
                       "there is no single precision for " + *why + ": choose the precision f64");
      return std::make_unique<Dynamics>(scene, assembly, couplings, options);
   }
   if (single)
      return std::make_unique<VectorMotion<float>>(scene, assembly, couplings, options);
   return std::make_unique<VectorMotion<double>>(scene, assembly, couplings, options);
}

/// The bound, or where it is asked for what is truly the limit; the bond is that of the bound in both cases.
StableStep stableLimit(const sdk::Call &call, const sdk::SceneView &scene, const Assembly &assembly,
                       const Couplings &couplings, const Options &options)
{
   StableStep limit = stableStep(assembly, options, couplings);
   if (!options.trueLimit)
      return limit;
   const auto rates = highestRates(call, Balance(scene, options));
   if (!rates)
      throw Failure(DIATOM_CANCELLED, "cancelled while the longest stable step was sought");
   limit.step =
       std::max(limit.step, longestStep(assembly, options, couplings, rates->stiffness, rates->damping));
   return limit;
}

} // namespace

void ExplicitRun::estimate(const sdk::Call &call, const Options &options, const sdk::SceneView &scene,
                           diatom_estimate &estimate)
{
   const Assembly assembly(scene, options);
   const Couplings couplings = makeCouplings(scene, assembly);
   const StableStep stable = stableLimit(call, scene, assembly, couplings, options);
   const double evaluations = std::max(1.0, static_cast<double>(stagesOf(options.integrator).size()));
   const auto cells = static_cast<double>(assembly.cells), links = static_cast<double>(assembly.links);
   // Measured on one 2020s core; of the vector kernel on dense blocks (bench/results), others take up to
   // three times as long.
   if (whyNotVector(assembly, couplings, options)) {
      estimate.bytes = cells * 900 + links * 380;
      estimate.step_seconds = evaluations * (cells * 40e-9 + links * 55e-9);
   } else {
      const bool single = options.precision == Options::Precision::f32;
      estimate.bytes = cells * (single ? 400 : 520) + links * 25;
      const double all = (single ? 0.6 : 1) * evaluations * (cells * 2e-9 + links * 6e-9);
      estimate.step_seconds = assembly.law == Law::small ? 0.6 * all : all;
   }
   if (options.trueLimit)
      estimate.bytes += cells * 3e3; // while the eigenvalue is sought
   estimate.stable_step = stable.step;
   estimate.stable_link = stable.bond < 0 ? -1 : assembly.link[stable.bond];
}

ExplicitRun::ExplicitRun(const sdk::Call &call, const Options &options, const sdk::SceneView &scene)
    : m_options(options), m_assembly(scene, m_options), m_couplings(makeCouplings(scene, m_assembly)),
      m_index(indices(scene)), m_motion(motionFor(scene, m_assembly, m_couplings, m_options)),
      m_stable(stableLimit(call, scene, m_assembly, m_couplings, m_options)),
      m_output{{{"position", "m", m_assembly.cells, 3},
                {"rotation", "", m_assembly.cells, 4},
                {"velocity", "m/s", m_assembly.cells, 3},
                {"angular_velocity", "rad/s", m_assembly.cells, 3},
                {"energy", "J", 1, 6},
                {"momentum", "", 1, 6},
                {"strain", "", m_assembly.cells, 1},
                {"internal_force", "N", m_assembly.cells, 6},
                {"reaction", "N", m_assembly.cells, 6}}}
{
   const Energies start = energiesNow();
   m_balance = start.stored();
   double stiffest = 0;
   for (std::int64_t i = 0; i < m_assembly.links; ++i)
      stiffest =
          std::max(stiffest, m_assembly.constants[i].k[0] * m_assembly.lengthOf(i) * m_assembly.lengthOf(i));
   m_scale = start.kinetic + start.elastic + start.contact +
             1e-9 * stiffest; // 5e-5 strain in one bond is no growth
   m_outputs = {sizeof(diatom_outputs), static_cast<std::int64_t>(m_output.size()), m_output.data()};
}

std::string ExplicitRun::how() const
{
   const auto why = whyNotVector(m_assembly, m_couplings, m_options);
   return "motion in time by " + m_motion->how() + (why ? ", for " + *why : "");
}

void ExplicitRun::apply(const sdk::Call &, std::span<const diatom_channel> channels)
{
   const std::int64_t cells = m_assembly.cells;
   m_acting.reset();
   for (const diatom_channel &channel : channels) {
      const std::string_view name = channel.name;
      if (name == "force" && m_assembly.hasLoads)
         m_motion->setLoads(sdk::findChannel(channels, name, 6, cells));
      else if (name == "curve")
         m_motion->setCurves(channels);
      else if (name == "source")
         m_motion->setSources(sdk::findChannel(channels, name, 6, cells));
      else if (name == "gravity" && m_assembly.hasGravity && channel.count == 1) {
         const double *g = sdk::findChannel(channels, name, 3, -1).row(0);
         const double before = energiesNow().gravity;
         std::copy_n(g, 3, m_assembly.gravity.begin());
         m_motion->gravityChanged();
         m_motion->addWork(energiesNow().gravity - before);
      } else
         throw Failure(DIATOM_UNSUPPORTED, "a change of \"" + std::string(name) + "\" needs a new run");
   }
}

std::string ExplicitRun::whereText(std::int64_t bond, std::int64_t cell) const
{
   const auto name = [&](std::int64_t i) {
      const auto &at = m_index[i];
      return "(" + std::to_string(at[0]) + ", " + std::to_string(at[1]) + ", " + std::to_string(at[2]) + ")";
   };
   if (bond >= 0)
      return "the bond of cells " + name(m_assembly.a[bond]) + " and " + name(m_assembly.b[bond]);
   return cell >= 0 ? "the cell " + name(cell) : "the drag";
}

double ExplicitRun::chooseStep(const diatom_step_request &request) const
{
   if (request.step == 0)
      return m_options.safety * m_stable.step;
   if (!(request.step > 0) || std::isinf(request.step))
      throw Failure(DIATOM_BAD_INPUT,
                    "the step must be a positive number of seconds, or 0 for the stable one");
   if (request.step > m_stable.step * (1 + 1e-9) && !m_options.forceStep)
      throw Failure(DIATOM_LIMIT,
                    "the step of " + text(request.step) + " s is longer than the stable limit of " +
                        text(m_stable.step) + " s, which " + whereText(m_stable.bond, m_stable.cell) +
                        " sets; use at most that, or 0 for the solver's own step (force_step = 1 overrides)");
   return request.step;
}

const Acting &ExplicitRun::acting() const
{
   if (!m_acting)
      m_acting = m_motion->acting();
   return *m_acting;
}

bool ExplicitRun::diverged()
{
   // Energy of motion is cheap to tell and grows with all else; only where it has grown is the rest looked
   // at.
   const Motion::Moving moving = m_motion->moving();
   m_work = std::max(m_work, std::abs(m_motion->work()));
   m_fall = std::max(m_fall, std::abs(moving.gravity));
   const double most = kEnergyGrowth * (m_scale + m_work + m_fall);
   if (moving.kinetic <= most && std::isfinite(moving.gravity))
      return false;
   const double balance = energiesNow().stored() + m_motion->dissipated() - m_motion->work();
   return !std::isfinite(balance) || balance - m_balance > most;
}

void ExplicitRun::reportDivergence(const sdk::Call &call, double time, double step,
                                   diatom_step_result &result)
{
   // Beyond the limit the culprit is what sets it; which bond looks worst 64 steps later is chance.
   const bool beyond = step > m_stable.step * (1 + 1e-9);
   const std::int64_t cell = beyond ? m_stable.cell : brokenCell(m_assembly, m_motion->state());
   const std::int64_t bond =
       beyond ? m_stable.bond : worstBond(m_assembly, m_motion->state(), m_motion->rest());
   result.state = DIATOM_DIVERGED;
   result.bad_cell = cell;
   result.bad_link = bond < 0 ? -1 : m_assembly.link[bond];
   m_time = m_motion->restore();
   m_failed = true;
   call.report(DIATOM_ERROR, "the motion diverged at " + text(time) + " s, first at " +
                                 whereText(bond, cell) + "; the state of " + text(m_time) +
                                 " s is kept: use a step below " + text(step / 2) + " s, or damping");
}

void ExplicitRun::warnOfLargeTurns(const sdk::Call &call, bool last)
{
   if (m_assembly.law != Law::small || m_warned || (m_sinceLook < kLookEvery && !last))
      return;
   m_sinceLook = 0;
   const auto name = [this](std::int64_t bond) { return whereText(bond, -1); };
   if (const auto warning = largeTurnsIn(m_assembly, m_motion->state(), name)) {
      m_warned = true;
      call.report(DIATOM_WARNING, *warning);
   }
}

std::int32_t ExplicitRun::step(const sdk::Call &call, const diatom_step_request &request,
                               diatom_step_result &result)
{
   const FlushDenormals mode;
   m_acting.reset();
   result.steps = 0;
   result.bad_cell = result.bad_link = -1;
   result.state = m_failed ? DIATOM_DIVERGED : DIATOM_RUNNING;
   result.time = m_time;
   const double span = request.until - m_time;
   const double most = chooseStep(request);
   result.step = most;
   if (m_failed)
      return DIATOM_OK;
   if (!std::isfinite(request.until))
      throw Failure(DIATOM_BAD_INPUT, "the time to simulate until must be a number");
   if (!(span > 0)) {
      result.state = DIATOM_DONE;
      return DIATOM_OK;
   }
   // Whole steps of equal length that end exactly at `until`.
   const double wanted = std::max(1.0, std::ceil(span / most * (1 - 1e-12)));
   const double dt = span / wanted, start = m_time;
   const double allowed = request.max_steps > 0 ? static_cast<double>(request.max_steps) : wanted;
   result.step = dt;
   std::int32_t status = DIATOM_OK;
   for (double n = 0; n < wanted && n < allowed; ++n) {
      if (call.cancelled()) {
         status = DIATOM_CANCELLED;
         break;
      }
      m_motion->step(call, m_time, dt);
      m_time = n + 1 == wanted ? request.until : start + (n + 1) * dt;
      ++result.steps;
      const bool last = n + 1 == wanted || n + 1 == allowed;
      if (++m_sinceCheck < kCheckEvery && !last)
         continue;
      m_sinceCheck = 0;
      if (diverged()) {
         reportDivergence(call, m_time, dt, result);
         break;
      }
      m_motion->save(m_time);
      call.progress((n + 1) / wanted, "stepping");
   }
   result.time = m_time;
   if (result.state == DIATOM_RUNNING && m_time >= request.until)
      result.state = DIATOM_DONE;
   m_sinceLook += result.steps;
   warnOfLargeTurns(call, result.state == DIATOM_DONE);
   return status;
}

void ExplicitRun::read(std::int64_t output, std::int64_t first, std::int64_t count, double *values) const
{
   const State &state = m_motion->state();
   const auto rows = [&](int column, int stride) {
      for (std::int64_t i = 0; i < count; ++i)
         for (int k = 0; k < stride; ++k)
            values[i * stride + k] = state.column(column + k)[first + i];
   };
   if (output == 0) {
      for (std::int64_t i = 0; i < count; ++i)
         for (int k = 0; k < 3; ++k)
            values[3 * i + k] = m_assembly.rest[k][first + i] + state.column(k)[first + i];
   } else if (output == 1) {
      for (std::int64_t i = 0; i < count; ++i) {
         const Quat q = state.unitTurnOf(first + i);
         const double all[4] = {q.w, q.x, q.y, q.z};
         std::copy_n(all, 4, values + 4 * i);
      }
   } else if (output == 2) {
      rows(7, 3);
   } else if (output == 3) {
      rows(10, 3);
   } else if (output == 4 && count == 1) {
      const bool lags = m_motion->lags();
      const Energies now =
          lags ? energies(m_assembly, m_couplings, m_motion->caughtUp(acting()), m_motion->rest())
               : energiesNow();
      const double work = lags ? m_motion->workBy(acting()) : m_motion->work();
      const double all[6] = {now.kinetic, now.elastic, now.gravity, now.contact, m_motion->dissipated(),
                             work};
      std::copy_n(all, 6, values);
   } else if (output == 5 && count == 1) {
      const Momenta now = momenta(m_assembly, state);
      const double all[6] = {now.linear.x,  now.linear.y,  now.linear.z,
                             now.angular.x, now.angular.y, now.angular.z};
      std::copy_n(all, 6, values);
   } else if (output == 6) {
      const Column all = strains(m_assembly, state, m_motion->rest());
      std::copy_n(all.begin() + first, count, values);
   } else if (output == 7) {
      std::copy_n(acting().internal.begin() + 6 * first, 6 * count, values);
   } else if (output == 8) {
      const Column all = reactions(m_assembly, state, acting());
      std::copy_n(all.begin() + 6 * first, 6 * count, values);
   }
}

} // namespace bonds
