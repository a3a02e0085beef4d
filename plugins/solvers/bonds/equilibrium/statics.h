// Balance under loads that are raised in steps: all at once where that turns nothing far, in ever smaller
// parts where it does or where Newton's method loses its way.
#pragma once

#include "equilibrium/newton.h"

namespace bonds {

struct StaticsOptions
{
   double tolerance = 1e-9; // unbalanced force over the largest at work
   int steps = 0;           // at least so many load steps; 0 = as few as it takes
};

struct StaticsResult
{
   bool balanced = false, cancelled = false;
   int iterations = 0;
   double residual = 0, reached = 0; // part of the loads
   std::int64_t cell = -1;           // the worst
   std::int64_t freedom = -1;        // that nothing resists
   std::int64_t negative = -1;       // unstable directions, -1 when unknown
};

class Statics : public Equations
{
public:
   Statics(const Balance &balance, const Loading &start);

   /// From the loading of the last balance to another; on failure the last good state stays.
   StaticsResult solve(const sdk::Call &call, const Loading &target, const StaticsOptions &options,
                       State &state);
   /// How far a state is from balance under a loading, which counts as that of the last balance from now on.
   Measure measureAt(const sdk::Call &call, const Loading &loading, const State &state);
   /// Of the last balance.
   const Loading &loading() const { return m_loading; }
   Newton &newton() { return m_newton; }

   Measure residual(const sdk::Call &call, const State &state, Vector &out) override;
   void tangent(const sdk::Call &call, const State &state, BlockMatrix &out) override;

private:
   Vector stillToMove(const Loading &next) const;
   StaticsResult place(const sdk::Call &call, const Loading &target, State &state);
   NewtonResult tryLoading(const sdk::Call &call, const Loading &next, double tolerance, State &trial);

   const Balance *m_balance;
   Newton m_newton;
   Loading m_loading; // of the last balance, or the one being tried
   Vector m_external;
};

} // namespace bonds
