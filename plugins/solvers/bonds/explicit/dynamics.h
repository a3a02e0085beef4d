// Motion in time: net force of every cell and the integrators. Absent effects are compiled out of the loops.
#pragma once

#include "explicit/acting.h"
#include "explicit/drive.h"
#include "explicit/forces.h"
#include "model/contact.h"
#include "model/coupling.h"

namespace bonds {

class Dynamics
{
public:
   Dynamics(const sdk::SceneView &scene, const Assembly &assembly, const Couplings &couplings,
            const Options &options);

   void step(const sdk::Call &call, double time, double dt);
   void setLoads(const sdk::Channel &loads);
   void setCurves(std::span<const diatom_channel> channels);
   void setSources(const sdk::Channel &sources) { m_actuation.setSources(sources); }

   const State &state() const { return m_state; }
   /// The actuated rest shape; null when nothing is driven.
   const RestShape *rest() const { return m_actuation.active() ? &m_rest : nullptr; }
   double dissipated() const { return m_dissipated; } // J since the start
   double work() const { return m_work; }             // J since the start
   void addWork(double joule) { m_work += joule; }

   Acting acting() const;
   /// State and work of the moment. Semi-implicit Euler carries velocities that are half a step behind the
   /// places: here they have caught up, so that balances are second order.
   State caughtUp(const Acting &acting) const;
   double workBy(const Acting &acting) const;

   /// All that changes while stepping, to go back to.
   struct Snapshot
   {
      State state;
      RestShape rest;
      Actuation actuation;
      Column reached;
      double dissipated = 0, work = 0, time = 0, behind = 0;
   };
   Snapshot snapshot(double time) const
   {
      return {m_state, m_rest, m_actuation, m_drive.reached(), m_dissipated, m_work, time, m_behind};
   }
   void save(double time, Snapshot &to) const;
   void restore(const Snapshot &from);

private:
   enum class Phase { kickDrift, halfDrift, predict, kickHalfDrift, stage };
   struct Stage
   {
      int number;
      double ahead; // s after the start of the step
      double next;  // s after the start of the step of the following stage
      double weight;
   };
   template<unsigned Effects>
   void piece(Phase phase, double dt, const Stage &stage, std::int64_t begin, std::int64_t end, Sums &sums);
   template<unsigned Effects>
   void net(std::int64_t i, double ahead, double weight, Vec3 &force, Vec3 &torque, Sums &sums);
   void drift(std::int64_t i, double dt);
   void stageCell(std::int64_t i, double dt, const Stage &stage, Vec3 force, Vec3 torque);
   void cells(const sdk::Call &call, Phase phase, double dt, const Stage &stage = Stage{0, 0, 0, 0});
   double restChange(double when);
   void acceptRest();
   void bondForces(const sdk::Call &call, double weight);
   void countDrive(double time);
   void semiImplicit(const sdk::Call &call, double time, double dt);
   void verlet(const sdk::Call &call, double time, double dt);
   void rungeKutta(const sdk::Call &call, double time, double dt);

   using Piece = void (Dynamics::*)(Phase, double, const Stage &, std::int64_t, std::int64_t, Sums &);
   using Net = void (Dynamics::*)(std::int64_t, double, double, Vec3 &, Vec3 &, Sums &);
   template<unsigned... Effects>
   void select(unsigned effects, std::integer_sequence<unsigned, Effects...>);

   const Assembly *m_assembly;
   const Couplings *m_couplings;
   Options::Integrator m_integrator;
   bool m_exact;
   Actuation m_actuation;
   Drive m_drive;
   State m_state;
   RestShape m_rest;
   RestShape m_counted; // whose work is counted; of couplings
   BondForcesPass m_bonds;
   CellForces m_between; // what couplings exert; empty columns without any
   Piece m_piece;
   Net m_net;
   Column m_loads;        // 6 per cell, empty without loads
   Column m_start, m_sum; // of Runge-Kutta: 13 per cell; of Verlet with damping: velocities
   std::vector<Sums> m_sums;
   double m_dissipated = 0, m_work = 0;
   double m_behind = 0; // s, by which the velocities of semi-implicit Euler lag
};

} // namespace bonds
