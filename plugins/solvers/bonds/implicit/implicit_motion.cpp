#include "implicit/implicit_motion.h"

#include "implicit/inertia.h"
#include "model/energy.h"

#include <cmath>

namespace bonds {

namespace {

constexpr int kMostHalvings = 12;
/// A chosen step aims at this part of what the tolerance allows, and is taken if it keeps within the whole.
constexpr double kAim = 0.8;
constexpr double kShrink = 0.2, kGrow = 2;
/// A step that could be longer by less than this stays, so that its factors serve on.
constexpr double kWorthWhile = 1.4;

/// Of the farthest, in the way that a step may err by a part of. Some fifty such steps in a row add up to the
/// tolerance.
constexpr double kTrembling = 0.02;

double reachOf(const State &state, double pitch)
{
   double most = 0;
   for (std::int64_t i = 0; i < state.n; ++i)
      most = std::max({most, norm(state.displacementOf(i)) / pitch, norm(vec(state.turnOf(i)))});
   return most;
}

double gripEnergy(const Assembly &assembly, const State &state)
{
   double sum = 0;
   for (const Column &grip : state.grip)
      for (const double stretch : grip)
         sum += 0.5 * assembly.ground.stiffness * stretch * stretch;
   return sum;
}

} // namespace

ImplicitMotion::ImplicitMotion(Balance &balance, const ImplicitOptions &options, double firstStep,
                               State start)
    : m_balance(&balance), m_options(options), m_equations(balance, options.numericalDamping),
      m_newton(balance), m_now(balance.assembly().cells), m_from(balance.assembly().cells),
      m_next(balance.assembly().cells), m_wanted(firstStep)
{
   if (balance.assembly().hasFriction)
      for (Column &grip : start.grip)
         grip.assign(static_cast<std::size_t>(start.n), 0);
   m_now.state = std::move(start);
   m_now.driven = balance.unloaded(m_now.state).driven;
   m_loading = balance.loadingAt(0);
   m_internal = m_exerted = Vector::Zero(6 * m_now.state.n);
   m_next = m_from = m_now;
}

/// Forces on all cells at the moment; those of the account are of it afterwards.
const Vector &ImplicitMotion::forcesNow(const sdk::Call &call)
{
   const Vector still = Vector::Zero(6 * m_now.state.n);
   Vector unbalanced;
   Kinematics here = m_now;
   here.rate.setZero();
   m_equations.begin(m_now, 1, m_loading);
   m_equations.residual(call, still, here, unbalanced);
   take();
   return m_exerted;
}

void ImplicitMotion::settle(const sdk::Call &call)
{
   if (m_started)
      forcesNow(call);
}

void ImplicitMotion::take()
{
   m_internal = m_equations.internal();
   m_exerted = m_equations.exerted();
   m_ground = m_equations.ground();
   m_power = m_equations.dampingPower();
}

/// Accelerations at the start, and the speed of what is driven.
void ImplicitMotion::start(const sdk::Call &call)
{
   const Supports &supports = m_balance->supports();
   const double soon = 1e-3 * m_wanted, before = kineticEnergy(m_balance->assembly(), m_now.state);
   for (const Driven &driven : supports.driven())
      m_now.state.column(7 + driven.freedom)[driven.cell] =
          (supports.valueOf(driven, m_now.time + soon) - supports.valueOf(driven, m_now.time)) / soon;
   m_work += kineticEnergy(m_balance->assembly(), m_now.state) - before;
   const Vector force = forcesNow(call);
   m_jump = Vector::Zero(force.size());
   for (std::int64_t i = 0; i < m_now.state.n; ++i)
      accelerate(m_balance->assembly(), m_now.state, i, supports.free().data() + 6 * i, force.data() + 6 * i,
                 m_jump.data() + 6 * i);
   m_reach = curvesReach();
   m_started = true;
}

StepNewton::End ImplicitMotion::attempt(const sdk::Call &call, double h)
{
   if (!m_started)
      start(call);
   m_nextLoading = m_balance->loadingAt(m_now.time + h);
   m_equations.begin(m_now, h, m_nextLoading);
   if (m_jump.size() > 0) {
      // What the step is too long for answers a jump at once: as accelerations it would overshoot.
      m_newton.prepare(call, m_equations, m_next);
      const Vector jump = resolved(call, m_jump);
      m_from = m_now;
      m_from.rate += jump;
      m_from.carried += jump;
      m_equations.begin(m_from, h, m_nextLoading);
   }
   const StepNewton::End end = m_newton.solve(call, m_equations, m_increment, m_next);
   if (end == StepNewton::End::failed)
      ++m_effort.repeated;
   return end;
}

ImplicitMotion::End ImplicitMotion::by(const sdk::Call &call, double h)
{
   double left = h, part = h;
   const double shortest = h / (1 << kMostHalvings), end = m_now.time + h;
   while (left > 0.5 * shortest) {
      const StepNewton::End solved = attempt(call, std::min(part, left));
      if (solved == StepNewton::End::cancelled)
         return End::cancelled;
      if (solved == StepNewton::End::converged) {
         left -= m_equations.step();
         accept();
         continue;
      }
      m_newton.forget();
      part /= 2;
      if (part < shortest)
         return End::failed;
   }
   m_now.time = end;
   return End::done;
}

double ImplicitMotion::curvesReach() const
{
   double most = 0;
   for (const Driven &driven : m_balance->supports().driven())
      most = std::max(most,
                      m_balance->supports().farthest(driven) / (driven.freedom < 3 ? m_balance->pitch() : 1));
   return most;
}

/// What a change of velocities by `rate` (6 a cell) leaves of motion that the step can resolve: the filter of
/// Shampine and Baca (J. Comput. Appl. Math. 11, 1984).
Vector ImplicitMotion::resolved(const sdk::Call &call, const Vector &rate)
{
   const Assembly &assembly = m_balance->assembly();
   Vector force = m_equations.method().rateBy(m_equations.step()) * rate, out;
   for (std::int64_t i = 0; i < m_now.state.n; ++i) {
      force.segment<3>(6 * i) *= assembly.mass[i];
      force.segment<3>(6 * i + 3) =
          (inertiaOf(assembly, i, m_now.state.turnOf(i)) * force.segment<3>(6 * i + 3)).eval();
   }
   m_newton.filter(call, force, out);
   return out;
}

/// Estimated error of the step, over what is allowed: a part of the way at the highest speed so far, or of
/// the farthest so far where that is little (fast trembling that moves nothing far need not be followed);
/// and of speed likewise, which alone sees what a swing does where it turns round.
double ImplicitMotion::relativeError(const sdk::Call &call)
{
   const double h = m_equations.step();
   const AlphaMethod &method = m_equations.method();
   const Vector change = (m_next.rate - m_equations.from().rate) / h;
   m_speed = std::max(m_speed, m_newton.largest(m_increment) / h);
   m_rush = std::max(m_rush, m_newton.largest(m_next.trend));
   m_reach = std::max(m_reach, reachOf(m_next.state, m_balance->pitch()));
   const double way = std::max(h * m_speed, kTrembling * m_reach),
                hurry = std::max(h * h * m_rush, kTrembling * m_reach);
   double error = 0;
   if (way > 0)
      error = std::abs(method.error()) * h * h * h * m_newton.largest(resolved(call, change)) / way;
   if (hurry > 0 && m_change.size() > 0) {
      const Vector bend = (change - m_change) / (0.5 * (h + m_now.step));
      error = std::max(error, std::abs(method.speedError()) * h * h * h * h *
                                  m_newton.largest(resolved(call, bend)) / hurry);
   }
   m_nextChange = change;
   return error / m_options.tolerance;
}

ImplicitMotion::End ImplicitMotion::towards(const sdk::Call &call, double until)
{
   const double left = until - m_now.time;
   double h = left / std::max(1.0, std::ceil(left / m_wanted * (1 - 1e-9)));
   const double shortest = 1e-9 * m_wanted;
   const bool clipped = h < 0.99 * m_wanted;
   for (;;) {
      const StepNewton::End solved = attempt(call, h);
      if (solved == StepNewton::End::cancelled)
         return End::cancelled;
      double factor = 0.25;
      if (solved == StepNewton::End::converged) {
         const double error = relativeError(call);
         if (call.cancelled())
            return End::cancelled;
         factor = error > 0 ? std::clamp(std::sqrt(kAim / error), kShrink, kGrow) : kGrow;
         if (error <= 1) {
            const double next = factor < 1 || factor > kWorthWhile ? factor * h : h;
            m_wanted = clipped ? std::max(m_wanted, next) : next;
            m_change.swap(m_nextChange);
            const bool last = h >= left * (1 - 1e-9);
            accept();
            if (last)
               m_now.time = until;
            return End::done;
         }
         ++m_effort.repeated;
      } else {
         m_newton.forget();
      }
      h *= std::min(factor, 0.7);
      m_wanted = h;
      if (!(h > shortest))
         return End::failed;
   }
}

void ImplicitMotion::accept()
{
   const Assembly &assembly = m_balance->assembly();
   const double h = m_equations.step(), power = m_power,
                contact = m_balance->contactEnergy(m_now.state) + gripEnergy(assembly, m_now.state);
   const double drag = 2 * assembly.drag * kineticEnergy(assembly, m_now.state);
   const Vector exerted = m_exerted, ground = m_ground;
   take();
   m_dissipated += 0.5 * h * (power + m_power);
   if (assembly.hasDrag)
      m_dissipated += 0.5 * h * (drag + 2 * assembly.drag * kineticEnergy(assembly, m_next.state));
   if (assembly.hasGround)
      m_dissipated -= 0.5 * (ground + m_ground).dot(m_increment) + m_balance->contactEnergy(m_next.state) +
                      gripEnergy(assembly, m_next.state) - contact;
   for (std::size_t k = 0; k < m_nextLoading.force.size(); ++k)
      m_work += m_nextLoading.force[k] * m_increment[static_cast<Eigen::Index>(k)];
   // Actuators: what the change of rest shape adds, averaged over where the cells are before and after.
   if (m_balance->actuation().active())
      for (const State *state : {&m_now.state, &m_next.state})
         m_work += 0.5 * (m_balance->elasticEnergy(*state, m_nextLoading.rest) -
                          m_balance->elasticEnergy(*state, m_loading.rest));
   for (const Driven &driven : m_balance->supports().driven()) {
      const std::int64_t at = 6 * driven.cell + driven.freedom;
      double needed[6];
      inertiaForce(assembly, m_next.state, driven.cell, m_next.rate.data() + 6 * driven.cell, needed);
      m_work += (needed[driven.freedom] - 0.5 * (exerted[at] + m_exerted[at])) * m_increment[at];
   }
   std::swap(m_now, m_next);
   m_jump.resize(0);
   std::swap(m_loading, m_nextLoading);
   ++m_effort.steps;
   m_effort.shortest = m_effort.steps == 1 ? h : std::min(m_effort.shortest, h);
   m_effort.longest = std::max(m_effort.longest, h);
}

void ImplicitMotion::apply(const sdk::Call &call, std::span<const diatom_channel> channels)
{
   if (!m_started)
      start(call);
   const double gravity = m_balance->gravityEnergy(m_now.state);
   const double elastic = m_balance->elasticEnergy(m_now.state, m_loading.rest);
   const Vector before = forcesNow(call);
   m_balance->apply(channels);
   m_reach = std::max(m_reach, curvesReach());
   m_loading = m_balance->loadingAt(m_now.time);
   m_work += m_balance->gravityEnergy(m_now.state) - gravity +
             m_balance->elasticEnergy(m_now.state, m_loading.rest) - elastic;
   // What jumps changes the accelerations at once.
   const Vector jump = forcesNow(call) - before;
   const Vector &free = m_balance->supports().free();
   State still = m_now.state;
   std::fill_n(still.spin(0), 3 * still.n, 0.0);
   Vector rate = Vector::Zero(jump.size());
   for (std::int64_t i = 0; i < still.n; ++i)
      accelerate(m_balance->assembly(), still, i, free.data() + 6 * i, jump.data() + 6 * i,
                 rate.data() + 6 * i);
   m_jump = m_jump.size() > 0 ? Vector(m_jump + rate) : rate;
   m_change.resize(0);
}

Vector ImplicitMotion::reaction() const
{
   Vector unbalanced = m_exerted;
   for (std::int64_t i = 0; i < m_now.state.n; ++i) {
      double needed[6];
      inertiaForce(m_balance->assembly(), m_now.state, i, m_now.rate.data() + 6 * i, needed);
      for (int k = 0; k < 6; ++k)
         unbalanced[6 * i + k] -= needed[k];
   }
   return ((m_balance->supports().free().array() - 1) * unbalanced.array()).matrix();
}

Effort ImplicitMotion::effort() const
{
   Effort out = m_effort;
   out.iterations = m_newton.iterations();
   out.factorisations = m_newton.factorisations();
   return out;
}

std::array<double, 6> ImplicitMotion::energy() const
{
   const Assembly &assembly = m_balance->assembly();
   const State &state = m_now.state;
   return {kineticEnergy(assembly, state),
           m_balance->elasticEnergy(state, m_loading.rest),
           m_balance->gravityEnergy(state),
           m_balance->contactEnergy(state) + gripEnergy(assembly, state),
           m_dissipated,
           m_work};
}

void ImplicitMotion::goBack(const Moment &moment)
{
   m_now = moment.now;
   m_loading = moment.loading;
   m_internal = moment.internal;
   m_exerted = moment.exerted;
   m_ground = moment.ground;
   m_power = moment.power;
   m_dissipated = moment.dissipated;
   m_work = moment.work;
}

} // namespace bonds
