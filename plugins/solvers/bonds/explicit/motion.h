// Motion in time step by step, however the forces are computed: what drives, loads and actuates the cells,
// and the account of work.
#pragma once

#include "explicit/acting.h"
#include "explicit/drive.h"
#include "model/actuation.h"

namespace bonds {

class Motion
{
public:
   virtual ~Motion() = default;
   Motion(const Motion &) = delete;
   Motion &operator=(const Motion &) = delete;

   void step(const sdk::Call &call, double time, double dt);
   virtual void setLoads(const sdk::Channel &loads);
   virtual void gravityChanged() {}
   void setSources(const sdk::Channel &sources);
   void setCurves(std::span<const diatom_channel> channels);

   /// The state of the moment.
   const State &state() const
   {
      readState();
      return m_state;
   }
   /// The actuated rest shape; null when nothing is driven.
   const RestShape *rest() const { return m_actuation.active() ? &m_rest : nullptr; }
   double dissipated() const { return m_dissipated; }   // J since the start
   double work() const { return m_work + unsettled(); } // J since the start
   void addWork(double joule) { m_work += joule; }

   Acting acting() const;
   /// State and work of the moment. Semi-implicit Euler carries velocities that are half a step behind the
   /// places: here they have caught up, so that balances are second order.
   bool lags() const { return m_behind > 0; }
   State caughtUp(const Acting &acting) const;
   double workBy(const Acting &acting) const;

   struct Moving
   {
      double kinetic = 0, gravity = 0; // J
   };
   /// Cheap to tell; no numbers when the state has none.
   virtual Moving moving() const = 0;

   /// Remembers the present state, and goes back to it; returns its time.
   virtual void save(double time);
   virtual double restore();

   /// How the forces are computed, for reports: "one bond at a time", "AVX2, f64".
   virtual std::string how() const = 0;

protected:
   Motion(const sdk::SceneView &scene, const Assembly &assembly, const Couplings &couplings,
          const Options &options);

   virtual void advance(const sdk::Call &call, double time, double dt) = 0;
   /// Brings m_state up to date, where the state lives elsewhere; places and turns of the ends of actuated
   /// bonds alone.
   virtual void readState() const {}
   virtual void readActuated() const {}
   virtual void restChanged() {}

   const Assembly *m_assembly;
   const Couplings *m_couplings;
   Options::Integrator m_integrator;
   Actuation m_actuation;
   Drive m_drive;
   mutable State m_state;
   RestShape m_rest;
   Column m_loads; // 6 per cell, empty without loads
   double m_dissipated = 0, m_work = 0;
   double m_behind = 0; // s, by which the velocities of semi-implicit Euler lag

private:
   void actuate(double time, double dt);
   const std::vector<Relation> &look() const;
   double restChange(const std::vector<Relation> &seen, const RestShape &rest) const;
   void acceptRest();
   /// Work (J) of the last step's change of rest shape that is counted when the next one looks at the cells.
   double unsettled() const;
   void settle(const std::vector<Relation> &seen);

   RestShape m_next;    // at the end of the step
   RestShape m_counted; // whose work is counted; of couplings
   bool m_settled = true;
   double m_restTime = 0;                // s, of m_rest between steps
   mutable std::vector<Relation> m_seen; // by the last look

protected:
   /// All that changes while stepping, but the state.
   struct Account
   {
      Actuation::Shapes rest;
      Column reached;
      double dissipated, work, time, behind;
   };
   Account m_savedAccount;
   State m_saved{0};
};

} // namespace bonds
