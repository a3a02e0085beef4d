#include "implicit/step_newton.h"

#include <cmath>
#include <limits>

namespace bonds {

namespace {

constexpr int kMostIterations = 25;
/// Corrections that shrink less than this are not worth going on with the tangent at hand.
constexpr double kSlow = 0.25;
/// More corrections than this cost more than factors for the next step.
constexpr int kMany = 6;
/// What is left of the first correction, which is itself about what a step neglects.
constexpr double kEnough = 1e-4;
/// Factors of a step this much longer or shorter still serve.
constexpr double kOtherStep = 0.1;
/// Turn of a cell in one step, rad, beyond which the answer may be another one than the motion leads to.
constexpr double kMostTurn = 1.5;

double longestTurn(const Vector &increment)
{
   double most = 0;
   for (Eigen::Index i = 0; i < increment.size(); i += 6)
      most = std::max(most, increment.segment<3>(i + 3).squaredNorm());
   return std::sqrt(most);
}

} // namespace

StepNewton::StepNewton(const Balance &balance)
    : m_balance(&balance), m_matrix(balance.pattern()),
      m_inverse(makeInverse(m_matrix, balance.supports().free(),
                            placesOf(balance.assembly(), State(balance.assembly().cells))))
{}

double StepNewton::largest(const Vector &change) const
{
   const double pitch = m_balance->pitch();
   double most = 0;
   for (Eigen::Index i = 0; i < change.size(); i += 6)
      most = std::max({most, change.segment<3>(i).squaredNorm() / (pitch * pitch),
                       change.segment<3>(i + 3).squaredNorm()});
   return std::sqrt(most);
}

/// What the last digits of displacements and turns are worth, as largest() counts.
double StepNewton::rounding(const State &state) const
{
   constexpr double kDigits = 32 * std::numeric_limits<double>::epsilon();
   const double pitch = m_balance->pitch();
   double most = 0;
   for (std::int64_t i = 0; i < state.n; ++i)
      most =
          std::max({most, squared(state.displacementOf(i)) / (pitch * pitch), squared(vec(state.turnOf(i)))});
   return kDigits * std::sqrt(most);
}

void StepNewton::refresh(const sdk::Call &call, StepEquations &equations, const Vector &increment,
                         const Kinematics &to)
{
   equations.tangent(call, increment, to, m_matrix);
   m_inverse->compute(call, m_matrix, placesOf(m_balance->assembly(), to.state));
   m_symmetric = true;
   for (std::int64_t i = 0; i < m_matrix.rows() && m_symmetric; ++i) {
      const auto own = m_matrix[m_matrix.diagonal(i)];
      m_symmetric = (own - own.transpose()).squaredNorm() < 1e-10 * own.squaredNorm();
   }
   m_length = equations.step();
   ++m_factorisations;
}

void StepNewton::prepare(const sdk::Call &call, StepEquations &equations, Kinematics &room)
{
   const Vector still = Vector::Zero(6 * room.state.n);
   equations.move(still, room);
   refresh(call, equations, still, room);
}

void StepNewton::correct(const sdk::Call &call, const Pass &pass, const Vector &r, Vector &change) const
{
   const Vector &free = m_balance->supports().free();
   if (pass.careful)
      minimalResidual(call, m_matrix, free, *m_inverse, r, 1e-8, 60, change);
   else if (m_inverse->exact())
      m_inverse->apply(call, r, change);
   else if (!m_symmetric ||
            conjugateGradients(call, m_matrix, free, *m_inverse, r, 1e-3, 300, change).indefinite)
      minimalResidual(call, m_matrix, free, *m_inverse, r, 1e-3, 100, change);
}

void StepNewton::filter(const sdk::Call &call, const Vector &r, Vector &x) const { correct(call, {}, r, x); }

/// Finds a faster way to the next correction; false when there is none left.
bool StepNewton::improve(const sdk::Call &call, StepEquations &equations, const Vector &increment,
                         const Kinematics &to, Pass &pass)
{
   if (!pass.fresh) {
      refresh(call, equations, increment, to);
      pass.fresh = true;
   } else if (!pass.careful) {
      // Once more where the iteration has come to, now with all of the tangent.
      refresh(call, equations, increment, to);
      pass.careful = true;
   } else {
      return pass.contraction < 0.9;
   }
   correct(call, pass, pass.residual, pass.change);
   pass.contraction = 1; // unknown
   return true;
}

StepNewton::End StepNewton::solve(const sdk::Call &call, StepEquations &equations, Vector &increment,
                                  Kinematics &to)
{
   const auto tried = [&](double part) {
      increment = equations.predicted(part);
      const End end = solveFrom(call, equations, increment, to);
      const bool jumps =
          end == End::converged && passesHalfTurn(m_balance->assembly(), equations.from().state, to.state);
      return jumps ? End::failed : end;
   };
   const End end = tried(1);
   if (end != End::failed)
      return end;
   // Where the step is too long for them, speeds tell nothing of where the cells will be.
   forget();
   return tried(0);
}

/// With a first guess of the increments.
StepNewton::End StepNewton::solveFrom(const sdk::Call &call, StepEquations &equations, Vector &increment,
                                      Kinematics &to)
{
   Pass pass;
   equations.move(increment, to);
   if (std::abs(equations.step() - m_length) > kOtherStep * m_length) {
      refresh(call, equations, increment, to);
      pass.fresh = true;
   }
   const double digits = rounding(to.state);
   for (int n = 0; n < kMostIterations; ++n) {
      if (call.cancelled())
         return End::cancelled;
      ++m_iterations;
      const Measure measure = equations.residual(call, increment, to, pass.residual);
      if (!std::isfinite(measure.unbalanced) || !pass.residual.allFinite())
         return End::failed;
      correct(call, pass, pass.residual, pass.change);
      double size = largest(pass.change);
      if (n > 0 && pass.last > 0)
         pass.contraction = size / pass.last;
      const bool exhausted = size <= digits || measure.unbalanced <= measure.rounding;
      if (n > 0 && pass.contraction > kSlow && !exhausted) {
         if (!improve(call, equations, increment, to, pass))
            return End::failed;
         size = largest(pass.change);
      }
      StepEquations::turnOn(pass.change, increment);
      if (!std::isfinite(size) || !(longestTurn(increment) < kMostTurn))
         return End::failed;
      equations.move(increment, to);
      if (n == 0)
         pass.first = size;
      const double left = pass.contraction < 1 ? size * pass.contraction / (1 - pass.contraction) : size;
      if (exhausted || left <= kEnough * pass.first) {
         if (n + 1 > kMany && !pass.fresh)
            forget();
         return End::converged;
      }
      pass.last = size;
   }
   return End::failed;
}

} // namespace bonds
