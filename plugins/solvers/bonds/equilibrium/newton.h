// Newton's method on finite rotations: each step is tried until the next correction is sure to be smaller
// (the natural test of Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 3.3, which does not
// mind how stiff the stiff directions are).
#pragma once

#include "equilibrium/balance.h"
#include "equilibrium/linear_solver.h"

namespace bonds {

/// Whether a bond comes to be turned by more than half a turn, or by less: what is shorter changes there, and
/// the law jumps.
bool passesHalfTurn(const Assembly &assembly, const State &from, const State &to);

/// Where the cells are.
Places placesOf(const Assembly &assembly, const State &state);

/// What is to vanish.
class Equations
{
public:
   virtual ~Equations() = default;
   /// Forces out of balance at a state, 6 a cell, held degrees of freedom included.
   virtual Measure residual(const sdk::Call &call, const State &state, Vector &out) = 0;
   /// Negative derivative of the residual by displacement and spin.
   virtual void tangent(const sdk::Call &call, const State &state, BlockMatrix &out) = 0;
};

struct NewtonResult
{
   enum class End { converged, stalled, singular, cancelled };
   End end = End::converged;
   int iterations = 0;
   Measure measure;
   std::int64_t freedom = -1; // that nothing holds
};

class Newton
{
public:
   explicit Newton(const Balance &balance);

   /// Changes `state` until its residual over the largest force at work is below `tolerance`. `prescribed`
   /// (6 a cell, may be empty) is what held degrees of freedom still have to move.
   NewtonResult solve(const sdk::Call &call, Equations &equations, State &state, Vector prescribed,
                      double tolerance);
   /// The tangent of other equations is wanted from now on.
   void forget() { m_current = false; }
   /// The symmetric inverse of the last tangent.
   const Inverse &inverse() const { return *m_inverse; }
   const BlockMatrix &matrix() const { return m_matrix; }
   Inverse &prepare(const sdk::Call &call, Equations &equations, const State &state);

private:
   /// Where one iteration stands.
   struct Pass
   {
      Vector residual, change;
      Vector prescribed; // empty when nothing is left to move
      Measure measure;
      double size = 0; // of the change, as the natural test counts it
      double contraction = 1;
      bool full = false; // the last step was not shortened
   };
   void firstCorrection(const sdk::Call &call, double tolerance, Pass &pass) const;
   bool tryStep(const sdk::Call &call, Equations &equations, Pass &pass, State &state);
   void polish(const sdk::Call &call, Equations &equations, Pass &pass, State &state);
   void correction(const sdk::Call &call, const Vector &r, const Vector &prescribed, double tolerance,
                   Vector &out) const;
   void estimate(const sdk::Call &call, const Vector &r, const Vector &prescribed, Vector &out) const;
   double size(const Vector &change) const;
   double longest(const Vector &change) const;

   const Balance *m_balance;
   BlockMatrix m_matrix;
   std::unique_ptr<Inverse> m_inverse;
   bool m_current = false;  // factors of a tangent are there
   bool m_symmetric = true; // the last tangent was
};

} // namespace bonds
