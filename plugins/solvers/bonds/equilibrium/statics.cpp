#include "equilibrium/statics.h"

#include <cmath>

namespace bonds {

namespace {

constexpr double kSmallestLoadStep = 1.0 / 4096;
/// Most turn of a cell in one load step, rad. A balance farther off may be another one than the loads lead
/// to, across a limit point.
constexpr double kMostTurn = 1;

/// Largest turn of a cell from one state to another, rad; where turns are linear none leads astray.
double turnBetween(const State &a, const State &b)
{
   double most = 0;
   for (std::int64_t i = 0; !a.smallTurns && i < a.n; ++i) {
      const Quat p = a.turnOf(i), q = b.turnOf(i);
      const Vec3 v = p.w * vec(q) - q.w * vec(p) - cross(vec(p), vec(q));
      most = std::max(most, 2 * std::atan2(norm(v), std::abs(p.w * q.w + dot(vec(p), vec(q)))));
   }
   return most;
}

} // namespace

Statics::Statics(const Balance &balance, const Loading &start)
    : m_balance(&balance), m_newton(balance), m_loading(start)
{}

Measure Statics::residual(const sdk::Call &call, const State &state, Vector &out)
{
   Measure measure;
   m_balance->internal(call, state, m_loading, false, out, measure);
   m_balance->external(state, m_loading, m_external, measure);
   out += m_external;
   m_balance->weigh(out, measure);
   return measure;
}

void Statics::tangent(const sdk::Call &call, const State &state, BlockMatrix &out)
{
   m_balance->stiffness(call, state, m_loading, 0, out);
}

Vector Statics::stillToMove(const Loading &next) const
{
   const auto &driven = m_balance->supports().driven();
   if (driven.empty())
      return {};
   Vector out = Vector::Zero(6 * m_balance->assembly().cells);
   for (std::size_t i = 0; i < driven.size(); ++i)
      out[6 * driven[i].cell + driven[i].freedom] = next.driven[i] - m_loading.driven[i];
   return out;
}

Measure Statics::measureAt(const sdk::Call &call, const Loading &loading, const State &state)
{
   m_loading = loading;
   Vector unbalanced;
   return residual(call, state, unbalanced);
}

NewtonResult Statics::tryLoading(const sdk::Call &call, const Loading &next, double tolerance, State &trial)
{
   Vector move = stillToMove(next);
   m_loading = next;
   return m_newton.solve(call, *this, trial, std::move(move), tolerance);
}

/// Where nothing is free the drives alone say where all is, whatever way leads there.
StaticsResult Statics::place(const sdk::Call &call, const Loading &target, State &state)
{
   const State from = state;
   if (const Vector move = stillToMove(target); move.size() > 0)
      advance(from, move, 1, state);
   StaticsResult out;
   out.residual = measureAt(call, target, state).relative();
   out.balanced = true;
   out.reached = 1;
   out.negative = 0;
   return out;
}

StaticsResult Statics::solve(const sdk::Call &call, const Loading &target, const StaticsOptions &options,
                             State &state)
{
   if (m_balance->supports().free().isZero(0))
      return place(call, target, state);
   StaticsResult out;
   const Loading start = m_loading;
   double longest = options.steps > 0 ? 1.0 / options.steps : 1, step = longest;
   while (out.reached < 1) {
      const double next = out.reached + step > 1 - 1e-9 ? 1 : out.reached + step;
      const Loading last = m_loading;
      State trial = state;
      const NewtonResult result =
          tryLoading(call, next == 1 ? target : blend(start, target, next), options.tolerance, trial);
      out.iterations += result.iterations;
      out.residual = result.measure.relative();
      out.cell = result.measure.cell;
      const double turn = turnBetween(state, trial);
      if (result.end == NewtonResult::End::converged && turn <= kMostTurn) {
         out.reached = next;
         state = std::move(trial);
         step = std::min({longest, 2 * step, turn > 0 ? 0.8 * step * kMostTurn / turn : longest});
         call.progress(out.reached, "loading");
         continue;
      }
      m_loading = last;
      m_newton.forget();
      out.cancelled = result.end == NewtonResult::End::cancelled;
      out.freedom = result.freedom;
      const bool far = result.end == NewtonResult::End::converged;
      step *= far ? std::min(0.5, 0.8 * kMostTurn / turn) : 0.5;
      if (out.cancelled || step < kSmallestLoadStep || (result.freedom >= 0 && out.reached == 0))
         return out;
   }
   out.balanced = true;
   if (m_newton.inverse().exact()) // Newton's last tangent is that of a state on the way
      out.negative = m_newton.prepare(call, *this, state).negative();
   return out;
}

} // namespace bonds
