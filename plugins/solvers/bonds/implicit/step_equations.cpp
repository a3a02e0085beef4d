#include "implicit/step_equations.h"

#include "implicit/inertia.h"

namespace bonds {

namespace {

/// (1 - x/2 cot x/2) / x^2 by its square.
double turnSeries(double xx)
{
   if (xx < 0.04)
      return 1.0 / 12 + xx / 720 * (1 + xx / 42 * (1 + xx / 40));
   const double half = 0.5 * std::sqrt(xx);
   return (1 - half / std::tan(half)) / xx;
}

/// How a rotation vector changes when the turn goes on by a small spin in world axes: the inverse of the
/// exponential's derivative (Iserles et al., Lie-group methods, Acta Numerica 9, 2000).
Vec3 turnedOn(Vec3 x, Vec3 spin)
{
   const Vec3 once = cross(x, spin);
   return x + spin - 0.5 * once + turnSeries(dot(x, x)) * cross(x, once);
}

Vec3 at(const Vector &v, std::int64_t i) { return {v[i], v[i + 1], v[i + 2]}; }

} // namespace

StepEquations::StepEquations(const Balance &balance, double numericalDamping)
    : m_balance(&balance), m_method(numericalDamping)
{}

// The auxiliary acceleration is that at a fixed part of a step later: a step of another length needs another
// one, or the order is lost.
Vector StepEquations::carriedFor(const Kinematics &motion, double h) const
{
   constexpr double kMostGrowth = 2; // after a stretch of far shorter steps
   if (motion.step == 0 || motion.step == h)
      return motion.carried;
   return motion.rate + std::min(h / motion.step, kMostGrowth) * (motion.carried - motion.rate);
}

void StepEquations::begin(const Kinematics &from, double h, const Loading &loading)
{
   m_from = &from;
   m_loading = &loading;
   m_step = h;
   m_carried = carriedFor(from, h);
   const std::vector<Driven> &driven = m_balance->supports().driven();
   m_slopes.resize(driven.size());
   for (std::size_t i = 0; i < driven.size(); ++i)
      m_slopes[i] = slope(driven[i]);
}

/// Of a driven degree of freedom's curve about the end of the step; second order where it is smooth.
double StepEquations::slope(const Driven &driven) const
{
   const double end = m_from->time + m_step;
   const Supports &supports = m_balance->supports();
   return (supports.valueOf(driven, end + 0.5 * m_step) - supports.valueOf(driven, end - 0.5 * m_step)) /
          m_step;
}

Vector StepEquations::predicted(double part) const
{
   const State &state = m_from->state;
   const Supports &supports = m_balance->supports();
   Vector out(6 * state.n);
   for (std::int64_t i = 0; i < state.n; ++i)
      for (int k = 0; k < 6; ++k) {
         const double speed = state.column(7 + k)[i] + 0.5 * m_step * m_from->trend[6 * i + k];
         out[6 * i + k] = supports.held(i, k) ? 0 : part * m_step * speed;
      }
   for (std::size_t i = 0; i < supports.driven().size(); ++i) {
      const Driven &driven = supports.driven()[i];
      out[6 * driven.cell + driven.freedom] = m_loading->driven[i] - m_from->driven[i];
   }
   return out;
}

void StepEquations::turnOn(const Vector &change, Vector &increment)
{
   for (Eigen::Index i = 0; i < increment.size(); i += 6) {
      increment.segment<3>(i) += change.segment<3>(i);
      const Vec3 turn = turnedOn(at(increment, i + 3), at(change, i + 3));
      increment.segment<3>(i + 3) << turn.x, turn.y, turn.z;
   }
}

void StepEquations::move(const Vector &increment, Kinematics &to) const
{
   const State &from = m_from->state;
   const double h = m_step, beta = m_method.beta, gamma = m_method.gamma, f = m_method.force,
                m = m_method.mass;
   const Vector &free = m_balance->supports().free();
   advance(from, increment, 1, to.state);
   to.time = m_from->time + h;
   to.step = h;
   to.driven = m_loading->driven;
   for (std::int64_t i = 0; i < from.n; ++i)
      for (int k = 0; k < 6; ++k) {
         const std::int64_t at = 6 * i + k;
         const double v = from.column(7 + k)[i], a = m_carried[at];
         if (free[at] == 0) { // held; what is driven follows below
            to.state.column(7 + k)[i] = to.carried[at] = to.rate[at] = to.trend[at] = 0;
            continue;
         }
         const double next = (increment[at] / h - v - (0.5 - beta) * h * a) / (beta * h);
         const double speed = v + h * ((1 - gamma) * a + gamma * next);
         to.carried[at] = next;
         to.rate[at] = ((1 - m) * next + m * a - f * m_from->rate[at]) / (1 - f);
         to.state.column(7 + k)[i] = speed;
         to.trend[at] = (speed - v) / h;
      }
   for (std::size_t i = 0; i < m_slopes.size(); ++i) {
      const Driven &driven = m_balance->supports().driven()[i];
      const std::int64_t at = 6 * driven.cell + driven.freedom;
      const double speed = m_slopes[i], v = from.column(7 + driven.freedom)[driven.cell];
      to.state.column(7 + driven.freedom)[driven.cell] = speed;
      to.rate[at] = to.carried[at] = to.trend[at] = (speed - v) / h;
   }
}

Measure StepEquations::residual(const sdk::Call &call, const Vector &increment, Kinematics &to, Vector &out)
{
   Measure measure;
   m_power =
       m_balance->internal(call, to.state, *m_loading, m_balance->assembly().damped, m_internal, measure);
   m_balance->external(to.state, *m_loading, m_external, measure);
   m_exerted = m_internal + m_external;
   addOutside(increment, to, measure);
   out.resize(m_exerted.size());
   for (std::int64_t i = 0; i < to.state.n; ++i) {
      double needed[6];
      inertiaForce(m_balance->assembly(), to.state, i, to.rate.data() + 6 * i, needed);
      for (int k = 0; k < 6; ++k)
         out[6 * i + k] = m_exerted[6 * i + k] - needed[k];
   }
   m_balance->weigh(out, measure);
   return measure;
}

/// Drag, and of the ground what a balance leaves out: damping and friction.
void StepEquations::addOutside(const Vector &increment, Kinematics &to, Measure &measure)
{
   const Assembly &assembly = m_balance->assembly();
   m_ground = Vector::Zero(assembly.hasGround ? m_exerted.size() : 0);
   for (std::int64_t i = 0; i < to.state.n && (assembly.hasDrag || assembly.hasGround); ++i) {
      auto force = m_exerted.segment<6>(6 * i);
      const Vec3 turn = spinMomentum(assembly, i, to.state.turnOf(i), to.state.spinOf(i));
      const double momentum[3] = {turn.x, turn.y, turn.z};
      for (int k = 0; k < 3 && assembly.hasDrag; ++k) {
         force[k] -= assembly.drag * assembly.mass[i] * to.state.column(7 + k)[i];
         force[3 + k] -= assembly.drag * momentum[k];
      }
      if (!assembly.hasGround)
         continue;
      const ContactForce contact =
          contactForce(assembly, m_from->state, to.state, i, increment.data() + 6 * i);
      const double spring = assembly.ground.stiffness * std::max(0.0, penetration(assembly, to.state, i));
      auto ground = m_ground.segment<6>(6 * i);
      const double h = assembly.halfHeight[i];
      ground << contact.along[0], contact.along[1], contact.normal, h * contact.along[1],
          -h * contact.along[0], 0;
      force += ground;
      force[2] -= spring;
      measure.atWork = std::max(measure.atWork, contact.normal);
      for (int j = 0; j < 2 && assembly.hasFriction; ++j)
         to.state.grip[j][i] = contact.grip[j];
   }
}

void StepEquations::tangent(const sdk::Call &call, const Vector &increment, const Kinematics &to,
                            BlockMatrix &out)
{
   const Assembly &assembly = m_balance->assembly();
   const double speedBy = m_method.speedBy(m_step), rateBy = m_method.rateBy(m_step),
                heavy = rateBy + assembly.drag * speedBy;
   m_balance->stiffness(call, to.state, *m_loading, assembly.damped ? speedBy : 0, out);
   for (std::int64_t i = 0; i < to.state.n; ++i) {
      auto own = out[out.diagonal(i)];
      const Eigen::Matrix3d inertia = inertiaOf(assembly, i, to.state.turnOf(i));
      own.topLeftCorner<3, 3>().diagonal().array() += heavy * assembly.mass[i];
      own.bottomRightCorner<3, 3>() += heavy * inertia;
      if (assembly.boxes) { // of w x I w
         const Vec3 w = to.state.spinOf(i);
         const Eigen::Vector3d spin(w.x, w.y, w.z), momentum = inertia * spin;
         for (int k = 0; k < 3; ++k) {
            const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
            own.col(3 + k).tail<3>() += speedBy * (spin.cross(inertia * axis) + axis.cross(momentum));
         }
      }
      if (!assembly.hasGround)
         continue;
      if (m_balance->stands(to.state, i))
         own(2, 2) -= assembly.ground.stiffness;
      addContactTangent(assembly,
                        contactForce(assembly, m_from->state, to.state, i, increment.data() + 6 * i), i,
                        speedBy, own);
   }
}

} // namespace bonds
