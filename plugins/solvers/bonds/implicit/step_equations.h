// The equations of motion at the end of one step, in the step's increments: displacements and rotation
// vectors in world axes (generalised-alpha on R3 x SO(3); Bruels and Cardona, J. Comput. Nonlinear Dyn. 5,
// 2010). All forces are those of the end of the step.
#pragma once

#include "equilibrium/balance.h"
#include "implicit/alpha_method.h"
#include "implicit/implicit_contact.h"
#include "implicit/kinematics.h"

namespace bonds {

class StepEquations
{
public:
   StepEquations(const Balance &balance, double numericalDamping);

   const AlphaMethod &method() const { return m_method; }
   /// The auxiliary acceleration where steps of length h go on from `motion`.
   Vector carriedFor(const Kinematics &motion, double h) const;
   /// Sets out from `from` over h, to where `loading` pulls. Both must stay.
   void begin(const Kinematics &from, double h, const Loading &loading);
   /// A first guess of the increments: this part of the way that speeds tell. Driven ones are right.
   Vector predicted(double part) const;
   /// Changes increments by displacements and spins at the end of the step.
   static void turnOn(const Vector &change, Vector &increment);
   /// What increments lead to.
   void move(const Vector &increment, Kinematics &to) const;
   /// Forces out of balance with inertia, held degrees of freedom included; friction settles in `to`.
   Measure residual(const sdk::Call &call, const Vector &increment, Kinematics &to, Vector &out);
   /// Negative derivative of the residual by displacement and spin, changes of frame within a step left out.
   void tangent(const sdk::Call &call, const Vector &increment, const Kinematics &to, BlockMatrix &out);

   const Kinematics &from() const { return *m_from; }
   double step() const { return m_step; }
   /// Of the last residual: power of damping (W), what bonds and couplings exert, what they and the loads
   /// exert together, what the ground exerts.
   double dampingPower() const { return m_power; }
   const Vector &internal() const { return m_internal; }
   const Vector &exerted() const { return m_exerted; }
   const Vector &ground() const { return m_ground; }

private:
   void addOutside(const Vector &increment, Kinematics &to, Measure &measure);
   double slope(const Driven &driven) const;

   const Balance *m_balance;
   AlphaMethod m_method;
   const Kinematics *m_from = nullptr;
   const Loading *m_loading = nullptr;
   Vector m_carried;
   Column m_slopes; // of driven degrees of freedom
   double m_step = 0, m_power = 0;
   Vector m_internal, m_exerted, m_external, m_ground;
};

} // namespace bonds
