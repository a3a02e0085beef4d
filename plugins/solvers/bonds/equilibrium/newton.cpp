#include "equilibrium/newton.h"

#include <cmath>

namespace bonds {

namespace {

constexpr int kMostIterations = 40;
constexpr double kShortestStep = 1.0 / 256;
/// A simplified correction this much smaller than the last is taken as it is, without a new tangent.
constexpr double kContraction = 0.1;
/// A correction this small (parts of the pitch, radians) is rounding.
constexpr double kRounding = 1e-13;
/// Forces of a stiff scene that turns cannot be known better than this part of them.
constexpr double kRoundingResidual = 1e-5;

} // namespace

bool passesHalfTurn(const Assembly &assembly, const State &from, const State &to)
{
   const auto cosine = [](Quat a, Quat b) { return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z; };
   for (std::int64_t i = 0; !from.smallTurns && i < assembly.links; ++i) {
      const std::int64_t a = assembly.a[i], b = assembly.b[i];
      const double before = cosine(from.turnOf(a), from.turnOf(b)),
                   after = cosine(to.turnOf(a), to.turnOf(b));
      if (!(before * after > 0))
         return true;
   }
   return false;
}

Places placesOf(const Assembly &assembly, const State &state)
{
   Places out(3, assembly.cells);
   for (std::int64_t i = 0; i < assembly.cells; ++i)
      for (int k = 0; k < 3; ++k)
         out(k, i) = assembly.rest[k][i] + state.column(k)[i];
   return out;
}

Newton::Newton(const Balance &balance)
    : m_balance(&balance), m_matrix(balance.pattern()),
      m_inverse(makeInverse(m_matrix, balance.supports().free(),
                            placesOf(balance.assembly(), State(balance.assembly().cells))))
{}

double Newton::size(const Vector &change) const
{
   const double pitch = m_balance->pitch();
   double sum = 0;
   for (Eigen::Index i = 0; i < change.size(); i += 6)
      sum += change.segment<3>(i).squaredNorm() / (pitch * pitch) + change.segment<3>(i + 3).squaredNorm();
   return std::sqrt(sum);
}

/// Largest spin of the cells of a bond against each other, rad.
double Newton::longest(const Vector &change) const
{
   const Assembly &assembly = m_balance->assembly();
   double most = 0;
   for (std::int64_t i = 0; i < assembly.links; ++i)
      most =
          std::max(most, (change.segment<3>(6 * assembly.b[i] + 3) - change.segment<3>(6 * assembly.a[i] + 3))
                             .squaredNorm());
   return std::sqrt(most);
}

Inverse &Newton::prepare(const sdk::Call &call, Equations &equations, const State &state)
{
   equations.tangent(call, state, m_matrix);
   m_inverse->compute(call, m_matrix, placesOf(m_balance->assembly(), state));
   m_symmetric = true;
   for (std::int64_t i = 0; i < m_matrix.rows() && m_symmetric; ++i) {
      const auto own = m_matrix[m_matrix.diagonal(i)];
      m_symmetric = (own - own.transpose()).squaredNorm() < 1e-10 * own.squaredNorm();
   }
   m_current = true;
   return *m_inverse;
}

void Newton::correction(const sdk::Call &call, const Vector &r, const Vector &prescribed, double tolerance,
                        Vector &out) const
{
   const Vector &free = m_balance->supports().free();
   Vector right = r;
   if (prescribed.size() > 0) {
      Vector moved;
      m_matrix.multiply(call, prescribed, moved);
      right -= moved;
   }
   if (m_inverse->exact())
      minimalResidual(call, m_matrix, free, *m_inverse, right, 1e-12, 40, out);
   else if (m_symmetric)
      conjugateGradients(call, m_matrix, free, *m_inverse, right, tolerance, 1000, out);
   else
      minimalResidual(call, m_matrix, free, *m_inverse, right, tolerance, 100, out);
   if (prescribed.size() > 0)
      out += prescribed;
}

/// What the natural test compares: the next correction with the same tangent, or one cycle of an inverse that
/// is only near.
void Newton::estimate(const sdk::Call &call, const Vector &r, const Vector &prescribed, Vector &out) const
{
   if (m_inverse->exact()) {
      correction(call, r, prescribed, 0, out);
      return;
   }
   Vector right = r;
   if (prescribed.size() > 0) {
      m_matrix.multiply(call, prescribed, out);
      right -= out;
   }
   m_inverse->apply(call, right, out);
}

bool Newton::tryStep(const sdk::Call &call, Equations &equations, Pass &pass, State &state)
{
   const Assembly &assembly = m_balance->assembly();
   const double limit = longest(pass.change);
   double factor = limit > 1 ? 1 / limit : 1;
   State trial = state;
   Vector residual, rest, next;
   for (; factor >= kShortestStep; factor /= 2) {
      if (call.cancelled())
         return false;
      advance(state, pass.change, factor, trial);
      if (passesHalfTurn(assembly, state, trial))
         continue;
      const Measure measure = equations.residual(call, trial, residual);
      if (!std::isfinite(measure.unbalanced) || !residual.allFinite())
         continue;
      rest = pass.prescribed.size() > 0 ? Vector((1 - factor) * pass.prescribed) : Vector();
      estimate(call, residual, factor < 1 ? rest : Vector(), next);
      const double after = size(next);
      if (!(after <= (1 - factor / 4) * pass.size || after < kRounding))
         continue;
      pass.contraction = pass.size > 0 ? after / pass.size : 0;
      pass.measure = measure;
      pass.full = factor == 1;
      pass.residual.swap(residual);
      pass.change.swap(next);
      pass.size = after;
      pass.prescribed = pass.full ? Vector() : rest;
      std::swap(state, trial);
      return true;
   }
   return false;
}

/// A last correction that comes for free: what is left afterwards is rounding.
void Newton::polish(const sdk::Call &call, Equations &equations, Pass &pass, State &state)
{
   State trial = state;
   advance(state, pass.change, 1, trial);
   const Measure measure = equations.residual(call, trial, pass.residual);
   if (!(measure.unbalanced < pass.measure.unbalanced))
      return;
   pass.measure = measure;
   std::swap(state, trial);
}

NewtonResult Newton::solve(const sdk::Call &call, Equations &equations, State &state, Vector prescribed,
                           double tolerance)
{
   NewtonResult out;
   Pass pass;
   if (prescribed.size() > 0 && prescribed.squaredNorm() > 0)
      pass.prescribed = std::move(prescribed);
   pass.measure = equations.residual(call, state, pass.residual);
   bool simplified = false; // `change` is there already, from the tangent of an earlier state
   bool here = false;       // the tangent is of this very state
   const auto end = [&](NewtonResult::End how) {
      out.end = how;
      out.measure = pass.measure;
      return out;
   };
   while (pass.prescribed.size() > 0 || !pass.measure.within(tolerance)) {
      if (call.cancelled())
         return end(NewtonResult::End::cancelled);
      if (out.iterations++ == kMostIterations)
         return end(NewtonResult::End::stalled);
      if (!simplified) {
         if (!m_current) {
            out.freedom = prepare(call, equations, state).singular();
            if (out.freedom >= 0)
               return end(NewtonResult::End::singular);
            here = true;
         }
         firstCorrection(call, tolerance, pass);
      }
      if (m_inverse->exact() && pass.prescribed.size() == 0 && pass.size < kRounding &&
          pass.measure.relative() < kRoundingResidual)
         break;
      if (tryStep(call, equations, pass, state)) {
         simplified = m_inverse->exact() && pass.full && pass.contraction < kContraction;
         m_current = simplified;
         here = false;
         continue;
      }
      if (call.cancelled())
         return end(NewtonResult::End::cancelled);
      if (here)
         return end(NewtonResult::End::stalled);
      simplified = m_current = false; // an old tangent was not good enough
   }
   if (out.iterations > 0 && m_inverse->exact())
      polish(call, equations, pass, state);
   return end(NewtonResult::End::converged);
}

void Newton::firstCorrection(const sdk::Call &call, double tolerance, Pass &pass) const
{
   const double enough = 0.3 * tolerance / std::max(pass.measure.relative(), tolerance);
   correction(call, pass.residual, pass.prescribed, std::clamp(enough, 1e-9, 1e-3), pass.change);
   if (m_inverse->exact()) {
      pass.size = size(pass.change);
      return;
   }
   Vector cycle;
   estimate(call, pass.residual, pass.prescribed, cycle);
   pass.size = size(cycle);
}

} // namespace bonds
