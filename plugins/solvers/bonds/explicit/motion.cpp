#include "explicit/motion.h"

#include <cmath>

namespace bonds {

namespace {

/// Parts of a step that two times may differ by and still be the same moment.
constexpr double kSameTime = 1e-6;

} // namespace

Motion::Motion(const sdk::SceneView &scene, const Assembly &assembly, const Couplings &couplings,
               const Options &options)
    : m_assembly(&assembly), m_couplings(&couplings), m_integrator(options.integrator),
      m_actuation(scene, assembly), m_drive(scene, assembly), m_state(assembly.cells, assembly.law),
      m_rest(m_actuation.shape()), m_next(m_rest),
      m_counted(couplings.empty() ? RestShape() : m_rest), m_savedAccount{}
{
   if (assembly.hasFriction)
      for (Column &grip : m_state.grip)
         grip.assign(static_cast<std::size_t>(assembly.cells), 0);
   if (assembly.hasLoads)
      Motion::setLoads(scene.channel("force", 6));
   for (std::int64_t i = 0; i < static_cast<std::int64_t>(assembly.velocity.size()); ++i)
      for (int k = 0; k < 6; ++k)
         m_state.column(7 + k)[i] = (assembly.fixed[i] >> k & 1) ? 0 : assembly.velocity[i][k];
   startPose(scene, m_state);
   if (m_drive.active())
      m_drive.place(0, m_state);
}

void Motion::setLoads(const sdk::Channel &loads)
{
   m_loads.assign(static_cast<std::size_t>(6 * m_assembly->cells), 0);
   for (std::int64_t i = 0; i < loads.count(); ++i)
      std::copy_n(loads.row(i), 6, m_loads.begin() + 6 * loads.where(i));
}

void Motion::setSources(const sdk::Channel &sources)
{
   if (m_actuation.active() && !m_settled)
      settle(look());
   m_actuation.setSources(sources);
}

void Motion::setCurves(std::span<const diatom_channel> channels)
{
   if (!m_drive.active())
      throw sdk::Failure(DIATOM_UNSUPPORTED, "nothing is driven: a change of \"curve\" needs a new run");
   m_drive.setCurves(channels);
}

void Motion::save(double time)
{
   if (!m_settled)
      settle(look());
   m_savedAccount = {m_actuation.accepted(), m_drive.reached(), m_dissipated, m_work, time, m_behind};
}

double Motion::restore()
{
   m_actuation.acceptAgain(m_savedAccount.rest, m_rest);
   if (!m_couplings->empty())
      m_counted = m_rest;
   m_settled = true;
   m_drive.goBack(m_savedAccount.reached);
   m_dissipated = m_savedAccount.dissipated;
   m_work = m_savedAccount.work;
   m_behind = m_savedAccount.behind;
   return m_savedAccount.time;
}

Acting Motion::acting() const { return actingOn(*m_assembly, *m_couplings, state(), rest(), m_loads); }

State Motion::caughtUp(const Acting &acting) const
{
   State now = state();
   kickBy(*m_assembly, acting, m_behind, now);
   return now;
}

double Motion::workBy(const Acting &acting) const
{
   double work = this->work();
   for (const Drive::Led &led : m_drive.cells())
      for (int k = 0; k < 6; ++k)
         if (led.mask >> k & 1)
            work -= m_behind * acting.all[6 * led.cell + k] * state().column(7 + k)[led.cell];
   return work;
}

const std::vector<Relation> &Motion::look() const
{
   readActuated();
   m_actuation.look(*m_assembly, m_state, m_seen);
   return m_seen;
}

/// What a rest shape adds to the energy of the accepted one.
double Motion::restChange(const std::vector<Relation> &seen, const RestShape &rest) const
{
   double change = m_actuation.energyChange(*m_assembly, seen, rest);
   for (const auto &coupling : *m_couplings)
      change += coupling->energy(m_state, &rest) - coupling->energy(m_state, &m_counted);
   return change;
}

void Motion::acceptRest()
{
   m_actuation.accept(m_rest);
   if (!m_couplings->empty())
      m_counted = m_rest;
}

double Motion::unsettled() const { return m_settled ? 0 : 0.5 * restChange(look(), m_rest); }

void Motion::settle(const std::vector<Relation> &seen)
{
   m_work += 0.5 * restChange(seen, m_rest);
   acceptRest();
   m_settled = true;
}

/// The rest shape goes from that of `time` to that of the step's end.
void Motion::actuate(double time, double dt)
{
   const std::vector<Relation> &seen = look();
   const bool goesOn = !m_settled && std::abs(time - m_restTime) < kSameTime * dt;
   if (!goesOn) { // first step, or new signals
      if (!m_settled)
         settle(seen);
      m_actuation.setRest(time, m_rest);
      m_work += restChange(seen, m_rest);
      acceptRest();
   }
   m_restTime = time + dt;
   m_actuation.setRest(m_restTime, m_next);
   m_work += 0.5 * restChange(seen, m_next); // where it goes on, the last step's half too
   acceptRest();
}

// The work of the actuators is the energy that the change of rest shape adds, averaged over where the cells
// are before and after the step: second order, and exact for a jump while nothing moves. Where they are after
// a step they are before the next: each looks at the cells once.
void Motion::step(const sdk::Call &call, double time, double dt)
{
   const bool actuated = m_actuation.active();
   if (actuated) {
      actuate(time, dt);
      restChanged();
   }
   advance(call, time, dt);
   if (actuated) {
      std::swap(m_rest, m_next);
      m_settled = false;
   }
}

} // namespace bonds
