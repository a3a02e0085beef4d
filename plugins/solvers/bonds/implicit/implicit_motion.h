// Motion in time by implicit steps: of one length, or as long as the wanted accuracy lets them be; and the
// account of energies on the way.
#pragma once

#include "implicit/step_newton.h"

namespace bonds {

struct ImplicitOptions
{
   double numericalDamping = 0.2;
   double tolerance = 1e-3; // of steps that are chosen
};

/// What the way has cost so far.
struct Effort
{
   std::int64_t steps = 0, iterations = 0, factorisations = 0;
   std::int64_t repeated = 0;        // steps begun again, shorter
   double shortest = 0, longest = 0; // s
};

class ImplicitMotion
{
public:
   ImplicitMotion(Balance &balance, const ImplicitOptions &options, double firstStep, State start);
   ImplicitMotion(const ImplicitMotion &) = delete;
   ImplicitMotion &operator=(const ImplicitMotion &) = delete;

   enum class End { done, failed, cancelled };
   /// Exactly h further, in shorter steps where Newton's method asks for them. Failed or cancelled on the
   /// way, it stays where the last good step led.
   End by(const sdk::Call &call, double h);
   /// One step as long as the accuracy allows, that ends at `until` or leaves room for another.
   End towards(const sdk::Call &call, double until);
   /// Channels of the scene that change now.
   void apply(const sdk::Call &call, std::span<const diatom_channel> channels);

   /// Makes the forces that are read those of the very moment.
   void settle(const sdk::Call &call);

   const Kinematics &motion() const { return m_now; }
   const Loading &loading() const { return m_loading; }
   const Vector &internal() const { return m_internal; }
   Vector reaction() const;
   Effort effort() const;
   std::int64_t worst() const { return m_worst; } // cell that moved most in the last attempt
   /// kinetic, elastic, gravity, contact, dissipated, work; J
   std::array<double, 6> energy() const;

   /// All that is read of a moment, to go back to once and for all: no steps follow.
   struct Moment
   {
      Kinematics now;
      Loading loading;
      Vector internal, exerted, ground;
      double power = 0, dissipated = 0, work = 0;
   };
   Moment moment() const
   {
      return {m_now, m_loading, m_internal, m_exerted, m_ground, m_power, m_dissipated, m_work};
   }
   void goBack(const Moment &moment);

private:
   void start(const sdk::Call &call);
   StepNewton::End attempt(const sdk::Call &call, double h);
   void accept();
   Vector resolved(const sdk::Call &call, const Vector &rate);
   double relativeError(const sdk::Call &call);
   double curvesReach() const;
   const Vector &forcesNow(const sdk::Call &call);
   void take();

   Balance *m_balance;
   ImplicitOptions m_options;
   StepEquations m_equations;
   StepNewton m_newton;
   Kinematics m_now, m_from, m_next; // `m_from` has in it what jumps
   Loading m_loading, m_nextLoading;
   Vector m_increment;
   Vector m_jump;                 // accelerations that set in at once; empty without
   Vector m_change, m_nextChange; // of accelerations, per time, over the last step and the tried one
   bool m_started = false;
   double m_wanted;    // s, the next chosen step
   double m_speed = 0; // the fastest so far, pitches or radians a second
   double m_rush = 0;  // the largest mean acceleration of a step so far, likewise
   double m_reach = 0; // the farthest so far or along a curve, pitches or radians
   std::int64_t m_worst = -1;
   Effort m_effort;

   // Of the moment, for the account.
   Vector m_internal, m_exerted, m_ground;
   double m_power = 0;                  // W, of damping
   double m_dissipated = 0, m_work = 0; // J
};

} // namespace bonds
