// Newton's method for one step in time. Factors are kept over steps and corrections while they serve: only
// how fast it converges depends on them, not what it converges to.
#pragma once

#include "equilibrium/newton.h"
#include "implicit/step_equations.h"

namespace bonds {

class StepNewton
{
public:
   explicit StepNewton(const Balance &balance);

   enum class End { converged, failed, cancelled };
   /// Finds the increments of a step that was begun, and what they lead to.
   End solve(const sdk::Call &call, StepEquations &equations, Vector &increment, Kinematics &to);
   /// Takes the tangent where a step begins; `room` is for the state there.
   void prepare(const sdk::Call &call, StepEquations &equations, Kinematics &room);
   /// x = A^-1 r with the last tangent A, roughly where it is not factorised.
   void filter(const sdk::Call &call, const Vector &r, Vector &x) const;
   /// The next step wants a tangent of its own.
   void forget() { m_length = 0; }

   std::int64_t iterations() const { return m_iterations; }         // so far
   std::int64_t factorisations() const { return m_factorisations; } // likewise, or set-ups of multigrid
   /// Largest displacement (parts of the pitch) or turn (rad) of a cell.
   double largest(const Vector &change) const;

private:
   End solveFrom(const sdk::Call &call, StepEquations &equations, Vector &increment, Kinematics &to);
   /// Of one step.
   struct Pass
   {
      Vector residual, change;
      double first = 0, last = 0, contraction = 1;
      bool fresh = false;   // the tangent is of this step
      bool careful = false; // with what is not symmetric in it
   };
   void refresh(const sdk::Call &call, StepEquations &equations, const Vector &increment,
                const Kinematics &to);
   void correct(const sdk::Call &call, const Pass &pass, const Vector &r, Vector &change) const;
   bool improve(const sdk::Call &call, StepEquations &equations, const Vector &increment,
                const Kinematics &to, Pass &pass);
   double rounding(const State &state) const;

   const Balance *m_balance;
   BlockMatrix m_matrix;
   std::unique_ptr<Inverse> m_inverse;
   double m_length = 0; // s, step that the factors are of; 0 = none
   bool m_symmetric = true;
   std::int64_t m_iterations = 0, m_factorisations = 0;
};

} // namespace bonds
