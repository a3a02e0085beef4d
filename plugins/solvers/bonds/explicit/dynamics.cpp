// Semi-implicit Euler, position Verlet and integrators in stages. Rotations move by the exponential of spin
// times step; cells that are no cubes keep their angular momentum, not their spin.
#include "explicit/dynamics.h"

#include "explicit/stages.h"

#include <limits>

namespace bonds {

namespace {

constexpr unsigned kGravity = 1, kDrag = 2, kLoads = 4, kGround = 8, kCouplings = 16;

unsigned effectsOf(const Assembly &assembly, const Couplings &couplings)
{
   return (assembly.hasGravity ? kGravity : 0) | (assembly.hasDrag ? kDrag : 0) |
          (assembly.hasLoads ? kLoads : 0) | (assembly.hasGround ? kGround : 0) |
          (couplings.empty() ? 0 : kCouplings);
}

/// Keeps a quaternion that is all but unit at length 1.
Quat renormalised(Quat q)
{
   const double f = 1.5 - 0.5 * (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
   return {f * q.w, f * q.x, f * q.y, f * q.z};
}

} // namespace

template<unsigned... Effects>
void Dynamics::select(unsigned effects, std::integer_sequence<unsigned, Effects...>)
{
   static constexpr Piece kPieces[] = {&Dynamics::piece<Effects>...};
   static constexpr Net kNets[] = {&Dynamics::net<Effects>...};
   m_piece = kPieces[effects];
   m_net = kNets[effects];
}

Dynamics::Dynamics(const sdk::SceneView &scene, const Assembly &assembly, const Couplings &couplings,
                   const Options &options)
    : Motion(scene, assembly, couplings, options), m_bonds(assembly, m_actuation.active()),
      m_sums(static_cast<std::size_t>((assembly.cells + kGrain - 1) / kGrain))
{
   select(effectsOf(assembly, couplings), std::make_integer_sequence<unsigned, 32>());
   const bool rates = assembly.damped || assembly.hasDrag || assembly.hasGround;
   if (!stagesOf(m_integrator).empty()) {
      m_start.resize(m_state.block.size());
      m_sum.resize(m_state.block.size());
   } else if (m_integrator == Options::Integrator::verlet && rates) {
      m_start.resize(static_cast<std::size_t>(6 * assembly.cells));
   }
   if (!couplings.empty())
      for (Column &column : m_between)
         column.resize(static_cast<std::size_t>(assembly.cells));
   save(0);
}

void Dynamics::save(double time)
{
   Motion::save(time);
   m_saved = m_state;
}

double Dynamics::restore()
{
   m_state = m_saved;
   return Motion::restore();
}

Motion::Moving Dynamics::moving() const
{
   Moving out;
   const Assembly &assembly = *m_assembly;
   const Vec3 g{assembly.gravity[0], assembly.gravity[1], assembly.gravity[2]};
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      const Vec3 v = m_state.velocityOf(i), w = m_state.spinOf(i);
      out.kinetic +=
          0.5 * (assembly.mass[i] * dot(v, v) + dot(w, spinMomentum(assembly, i, m_state.turnOf(i), w)));
      out.gravity -= assembly.mass[i] * dot(g, m_state.displacementOf(i));
   }
   return out;
}

template<unsigned Effects>
void Dynamics::net(std::int64_t i, double ahead, double weight, Vec3 &force, Vec3 &torque, Sums &sums)
{
   const Assembly &assembly = *m_assembly;
   m_bonds.gather(i, force, torque);
   if constexpr ((Effects & kCouplings) != 0) {
      force = force + Vec3{m_between[0][i], m_between[1][i], m_between[2][i]};
      torque = torque + Vec3{m_between[3][i], m_between[4][i], m_between[5][i]};
   }
   if constexpr ((Effects & kGravity) != 0) {
      const double m = assembly.mass[i];
      force = force + Vec3{m * assembly.gravity[0], m * assembly.gravity[1], m * assembly.gravity[2]};
   }
   if constexpr ((Effects & kLoads) != 0) {
      const double *load = m_loads.data() + 6 * i;
      force = force + Vec3{load[0], load[1], load[2]};
      torque = torque + Vec3{load[3], load[4], load[5]};
   }
   if constexpr ((Effects & kDrag) != 0) {
      const Vec3 v = m_state.velocityOf(i), w = m_state.spinOf(i);
      const Vec3 p = assembly.mass[i] * v, turn = spinMomentum(assembly, i, m_state.turnOf(i), w);
      force = force - assembly.drag * p;
      torque = torque - assembly.drag * turn;
      sums.dissipated += assembly.drag * (dot(p, v) + dot(turn, w)) * weight;
   }
   if constexpr ((Effects & kGround) != 0)
      addContact(assembly.ground, touchOf(assembly, m_state, i), ahead, weight, force, torque, sums);
}

void Dynamics::drift(std::int64_t i, double dt)
{
   for (int k = 0; k < 3; ++k)
      m_state.displacement(k)[i] += dt * m_state.velocity(k)[i];
   const Quat q = m_state.turnOf(i);
   Vec3 w = m_state.spinOf(i);
   if (m_state.smallTurns)
      return m_state.setTurnedOn(i, q, dt * w);
   if (!m_assembly->boxes) {
      m_state.setTurn(i, renormalised(exponential(dt * w) * q));
      return;
   }
   // Torque-free turn of a box: spin at the middle of the step from its constant angular momentum, second
   // order.
   const Vec3 momentum = spinMomentum(*m_assembly, i, q, w);
   w = spinFrom(*m_assembly, i, exponential((0.5 * dt) * w) * q, momentum, w);
   const Quat now = renormalised(exponential(dt * w) * q);
   m_state.setTurn(i, now);
   m_state.setSpin(i, spinFrom(*m_assembly, i, now, momentum, w));
}

void Dynamics::stageCell(std::int64_t i, double dt, const StageOfStep &stage, Vec3 force, Vec3 torque)
{
   const Assembly &assembly = *m_assembly;
   const Vec3 v = m_state.velocityOf(i), w = m_state.spinOf(i);
   const bool small = m_state.smallTurns;
   const Quat q = m_state.turnOf(i), turn = Quat{0, w.x, w.y, w.z} * (small ? Quat() : q);
   Vec3 spinRate{assembly.inverseInertia(i, 0) * torque.x, assembly.inverseInertia(i, 1) * torque.y,
                 assembly.inverseInertia(i, 2) * torque.z};
   if (assembly.boxes) {
      const Vec3 turning = small ? Vec3{} : cross(w, spinMomentum(assembly, i, q, w));
      spinRate = spinFrom(assembly, i, q, torque - turning, {});
   }
   const double rate[13] = {v.x,
                            v.y,
                            v.z,
                            0.5 * turn.w,
                            0.5 * turn.x,
                            0.5 * turn.y,
                            0.5 * turn.z,
                            assembly.inverseMass(i, 0) * force.x,
                            assembly.inverseMass(i, 1) * force.y,
                            assembly.inverseMass(i, 2) * force.z,
                            spinRate.x,
                            spinRate.y,
                            spinRate.z};
   for (int k = 0; k < 13; ++k) {
      const std::int64_t at = k * m_state.n + i;
      if (stage.first) {
         m_start[at] = m_state.block[at];
         m_sum[at] = 0;
      }
      m_sum[at] += stage.weight * rate[k];
      m_state.block[at] = m_start[at] + (stage.last ? dt * m_sum[at] : stage.next * rate[k]);
   }
   if (small)
      return;
   const Quat now = m_state.turnOf(i);
   const double f = 1 / std::sqrt(now.w * now.w + now.x * now.x + now.y * now.y + now.z * now.z);
   m_state.setTurn(i, {f * now.w, f * now.x, f * now.y, f * now.z});
}

template<unsigned Effects>
void Dynamics::piece(Phase phase, double dt, const StageOfStep &stage, std::int64_t begin, std::int64_t end,
                     Sums &sums)
{
   const auto moveGrip = [&](std::int64_t i, double time) {
      if constexpr ((Effects & kGround) != 0)
         if (m_assembly->hasFriction)
            driftContact(m_assembly->ground, touchOf(*m_assembly, m_state, i), time, sums);
   };
   // Work of the loads over a displacement made at velocity v and spin w.
   const auto countLoad = [&](std::int64_t i, double time) {
      if constexpr ((Effects & kLoads) != 0)
         for (int k = 0; k < 6; ++k)
            sums.work += time * m_loads[6 * i + k] * m_state.column(7 + k)[i];
   };
   const bool predicted = !m_start.empty();
   for (std::int64_t i = begin; i < end; ++i) {
      Vec3 force, torque;
      switch (phase) {
      case Phase::kickDrift:
         net<Effects>(i, 0, dt, force, torque, sums);
         kickCell(*m_assembly, i, dt, force, torque, m_state);
         countLoad(i, dt);
         moveGrip(i, dt);
         drift(i, dt);
         break;
      case Phase::halfDrift:
         countLoad(i, 0.5 * dt);
         moveGrip(i, 0.5 * dt);
         drift(i, 0.5 * dt);
         break;
      case Phase::predict: // velocities in the middle of the step, for what depends on them
         for (int k = 0; k < 6; ++k)
            m_start[k * m_state.n + i] = m_state.column(7 + k)[i];
         net<Effects>(i, 0, 0, force, torque, sums);
         kickCell(*m_assembly, i, 0.5 * dt, force, torque, m_state);
         break;
      case Phase::kickHalfDrift:
         net<Effects>(i, 0, dt, force, torque, sums);
         if (predicted)
            for (int k = 0; k < 6; ++k)
               m_state.column(7 + k)[i] = m_start[k * m_state.n + i];
         kickCell(*m_assembly, i, dt, force, torque, m_state);
         countLoad(i, 0.5 * dt);
         moveGrip(i, 0.5 * dt);
         drift(i, 0.5 * dt);
         break;
      case Phase::stage:
         net<Effects>(i, stage.ahead, dt * stage.weight, force, torque, sums);
         countLoad(i, dt * stage.weight);
         if (stage.last)
            moveGrip(i, dt);
         stageCell(i, dt, stage, force, torque);
         break;
      }
   }
}

void Dynamics::cells(const sdk::Call &call, Phase phase, double dt, const StageOfStep &stage)
{
   inPieces(call, m_assembly->cells >= kCellsForThreads, m_assembly->cells,
            [&, piece = m_piece](std::int64_t begin, std::int64_t end, std::int64_t number) {
               m_sums[number] = {};
               (this->*piece)(phase, dt, stage, begin, end, m_sums[number]);
            });
   for (const Sums &sums : m_sums) {
      m_dissipated += sums.dissipated;
      m_work += sums.work;
   }
}

void Dynamics::bondForces(const sdk::Call &call, double weight)
{
   double power = m_bonds.run(call, m_state, m_rest);
   if (!m_couplings->empty())
      for (Column &column : m_between)
         std::fill(column.begin(), column.end(), 0);
   for (const auto &coupling : *m_couplings)
      power += coupling->addForces(call, m_state, rest(), m_between);
   if (m_assembly->damped)
      m_dissipated += power * weight;
}

/// Work of the drives against the forces of the moment, at the velocities of the moment over `time`. What
/// they put into momentum is counted when a step ends.
void Dynamics::countDrive(double time)
{
   constexpr double kAhead = std::numeric_limits<double>::min(); // no time, but friction is not to slip twice
   for (const Drive::Led &led : m_drive.cells()) {
      Vec3 force, torque;
      Sums sums;
      (this->*m_net)(led.cell, kAhead, 0, force, torque, sums);
      const double f[6] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
      for (int k = 0; k < 6; ++k)
         if (led.mask >> k & 1)
            m_work -= time * f[k] * m_state.column(7 + k)[led.cell];
   }
}

void Dynamics::advance(const sdk::Call &call, double time, double dt)
{
   if (m_drive.active() && m_integrator != Options::Integrator::semiImplicit)
      m_drive.lead(*m_assembly, time, dt, m_state);
   if (!stagesOf(m_integrator).empty())
      inStages(call, time, dt);
   else if (m_integrator == Options::Integrator::verlet)
      verlet(call, time, dt);
   else
      semiImplicit(call, time, dt);
   if (m_drive.active())
      m_work += m_drive.arrive(*m_assembly, dt, m_state);
}

void Dynamics::semiImplicit(const sdk::Call &call, double time, double dt)
{
   bondForces(call, dt);
   if (m_drive.active()) {
      countDrive(m_behind);
      m_drive.lead(*m_assembly, time, dt, m_state);
      countDrive(0.5 * dt);
   }
   cells(call, Phase::kickDrift, dt);
   m_behind = 0.5 * dt;
}

void Dynamics::verlet(const sdk::Call &call, double time, double dt)
{
   cells(call, Phase::halfDrift, dt);
   if (m_actuation.active())
      m_actuation.setRest(time + 0.5 * dt, m_rest);
   if (!m_start.empty()) {
      bondForces(call, 0);
      cells(call, Phase::predict, dt);
   }
   bondForces(call, dt);
   countDrive(dt);
   cells(call, Phase::kickHalfDrift, dt);
}

void Dynamics::inStages(const sdk::Call &call, double time, double dt)
{
   const auto stages = stagesOf(m_integrator);
   for (std::size_t i = 0; i < stages.size(); ++i) {
      const Stage &part = stages[i];
      const StageOfStep stage{i == 0, i + 1 == stages.size(), dt * part.ahead, dt * part.next, part.weight};
      if (m_actuation.active())
         m_actuation.setRest(time + stage.ahead, m_rest);
      bondForces(call, dt * stage.weight);
      countDrive(dt * stage.weight);
      cells(call, Phase::stage, dt, stage);
   }
}

} // namespace bonds
