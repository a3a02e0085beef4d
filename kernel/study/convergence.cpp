#include "study/convergence.h"

#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

/// Orders an integrator may show: first order down to a half where a run has kinks (dry friction, square
/// waves), fourth order up to one more where the leading term happens to cancel.
constexpr double kLeastOrder = 0.5, kMostOrder = 5.5;
/// Changes below this part of the scale are rounding: double precision keeps 1e-16 a step, and some 1e4 steps
/// add up.
constexpr double kRounding = 1e-11;

Convergence judge(double coarseChange, double fineChange, double scale)
{
   Convergence found{coarseChange, fineChange, scale, std::nullopt, false, false};
   if (!(scale > 0) || !std::isfinite(coarseChange + fineChange + scale))
      return found;
   found.settled = coarseChange <= kRounding * scale;
   if (coarseChange > 0 && fineChange > 0 && !found.settled)
      found.order = std::log2(coarseChange / fineChange);
   found.asymptotic = found.order && *found.order >= kLeastOrder && *found.order <= kMostOrder;
   return found;
}

} // namespace

std::optional<double> Convergence::errorAt(double fraction) const
{
   if (settled)
      return std::max(coarseChange, kRounding * scale);
   if (!asymptotic)
      return std::nullopt;
   // The change from h to h/2 is error(h) - error(h/2) = error(h) (1 - 2^-order).
   return coarseChange / (1 - std::exp2(-*order)) * std::pow(fraction, *order);
}

std::optional<double> Convergence::relativeErrorAt(double fraction) const
{
   const auto error = errorAt(fraction);
   return error ? std::optional(*error / scale) : std::nullopt;
}

std::string Convergence::doubt() const
{
   if (asymptotic || settled)
      return "";
   if (!(scale > 0))
      return "the quantity does not move";
   if (!order)
      return "the runs differ by no more than rounding at one step and by more at another";
   return fmt::format("not in the asymptotic range: halving the step changes the result by {} % of its "
                      "largest value, halving it again by {} %",
                      fixedText(100 * coarseChange / scale, 3), fixedText(100 * fineChange / scale, 3));
}

double largestDifference(const History &a, const History &b, double until)
{
   double most = 0;
   for (std::size_t k = 0; k < std::min(a.value.size(), b.value.size()); ++k)
      if (a.time[k] <= until)
         most = std::max(most, std::abs(a.value[k] - b.value[k]));
   return most;
}

double largestValue(const History &curve, double until)
{
   double most = 0;
   for (std::size_t k = 0; k < curve.value.size(); ++k)
      if (curve.time[k] <= until)
         most = std::max(most, std::abs(curve.value[k]));
   return most;
}

Convergence convergenceOf(const History &coarse, const History &middle, const History &fine, double until)
{
   return judge(largestDifference(coarse, middle, until), largestDifference(middle, fine, until),
                largestValue(fine, until));
}

Convergence convergenceOf(double coarse, double middle, double fine)
{
   return judge(std::abs(coarse - middle), std::abs(middle - fine), std::abs(fine));
}

std::optional<ResolutionLimit> resolutionLimit(const std::array<double, 3> &times,
                                               const std::array<double, 3> &values)
{
   const double first = values[0] - values[1], second = values[1] - values[2];
   if (!(first * second > 0) || !(times[0] < times[1] && times[1] < times[2]))
      return std::nullopt;
   // The ratio of the two changes falls with the order, so that it is found by halving an interval.
   const auto power = [&](std::size_t k, double order) { return std::pow(times[k], -order); };
   const auto excess = [&](double order) {
      return (power(1, order) - power(2, order)) / (power(0, order) - power(1, order)) - second / first;
   };
   double low = kLeastOrder, high = kMostOrder;
   if (!(excess(low) > 0) || !(excess(high) < 0))
      return std::nullopt;
   for (int k = 0; k < 60; ++k) {
      const double middle = (low + high) / 2;
      (excess(middle) > 0 ? low : high) = middle;
   }
   const double c = second / (power(1, low) - power(2, low));
   return ResolutionLimit{values[2] - c * power(2, low), low};
}

} // namespace diatom
