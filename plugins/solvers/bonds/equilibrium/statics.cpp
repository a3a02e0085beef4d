#include "equilibrium/statics.h"

#include <cmath>
#include <string>

namespace bonds {

using sdk::Failure;

namespace {

constexpr double kSmallestLoadStep = 1.0 / 4096;
/// A load step that took fewer iterations lets the next be twice as long.
constexpr int kEasy = 8;

/// Number of the part of joined cells that each cell belongs to.
std::vector<std::int32_t> partsOf(const BlockMatrix &pattern, std::int32_t &count)
{
   std::vector<std::int32_t> part(static_cast<std::size_t>(pattern.rows()), -1), stack;
   count = 0;
   for (std::int32_t first = 0; first < pattern.rows(); ++first) {
      if (part[first] >= 0)
         continue;
      part[first] = count;
      stack.assign(1, first);
      while (!stack.empty()) {
         const std::int32_t i = stack.back();
         stack.pop_back();
         for (std::int64_t e = pattern.begin(i); e < pattern.end(i); ++e)
            if (part[pattern.column(e)] < 0) {
               part[pattern.column(e)] = count;
               stack.push_back(pattern.column(e));
            }
      }
      ++count;
   }
   return part;
}

} // namespace

std::string freedomText(int freedom)
{
   const std::string axis(1, "xyz"[freedom % 3]);
   return (freedom < 3 ? "moving along " : "turning about ") + axis;
}

void refuseDrifting(const Balance &balance)
{
   std::int32_t count = 0;
   const Assembly &assembly = balance.assembly();
   const std::vector<std::int32_t> part = partsOf(balance.pattern(), count);
   std::vector<std::array<bool, 3>> held(static_cast<std::size_t>(count));
   for (std::int64_t i = 0; i < assembly.cells; ++i)
      for (int k = 0; k < 3; ++k)
         held[part[i]][k] = held[part[i]][k] || balance.supports().held(i, k) || (k == 2 && assembly.hasGround);
   for (std::int64_t i = 0; i < assembly.cells; ++i)
      for (int k = 0; k < 3; ++k)
         if (!held[part[i]][k])
            throw Failure(DIATOM_BAD_INPUT, "nothing keeps the cell " + balance.name(i) +
                                                " and those joined to it from " + freedomText(k) +
                                                ": fix or support one of them");
}

Statics::Statics(const Balance &balance, const Loading &start)
    : m_balance(&balance), m_newton(balance), m_loading(start)
{
}

Measure Statics::residual(const sdk::Call &call, const State &state, Vector &out)
{
   double atWork = 0;
   m_balance->internal(call, state, m_loading, false, out, atWork);
   m_balance->external(state, m_loading, m_external, atWork);
   out += m_external;
   return m_balance->measure(out, atWork);
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

StaticsResult Statics::solve(const sdk::Call &call, const Loading &target, const StaticsOptions &options,
                             State &state)
{
   StaticsResult out;
   const Loading start = m_loading;
   const double longest = options.steps > 0 ? 1.0 / options.steps : 1;
   double step = longest;
   while (out.reached < 1) {
      const double next = out.reached + step > 1 - 1e-9 ? 1 : out.reached + step;
      const Loading last = m_loading;
      const Loading tried = next == 1 ? target : blend(start, target, next);
      const Vector move = stillToMove(tried);
      m_loading = tried;
      State trial = state;
      const NewtonResult result = m_newton.solve(call, *this, trial, move, options.tolerance);
      out.iterations += result.iterations;
      out.residual = result.measure.relative();
      out.cell = result.measure.cell;
      out.negative = result.negative;
      if (result.end == NewtonResult::End::converged) {
         out.reached = next;
         state = std::move(trial);
         if (result.iterations <= kEasy)
            step = std::min(longest, 2 * step);
         call.progress(out.reached, "loading");
         continue;
      }
      m_loading = last;
      m_newton.forget();
      out.cancelled = result.end == NewtonResult::End::cancelled;
      out.freedom = result.freedom;
      step /= 2;
      if (out.cancelled || step < kSmallestLoadStep || (result.freedom >= 0 && out.reached == 0))
         return out;
   }
   out.balanced = true;
   return out;
}

} // namespace bonds
