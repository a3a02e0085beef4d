// How results approach the exact one as the step shrinks: observed order, error by Richardson's
// extrapolation, and whether the step is small enough for either to mean something.
#pragma once

#include "study/quantity.h"

#include <array>
#include <optional>
#include <string>

namespace diatom {

/// From runs at h, h/2 and h/4 (Roache, "Quantification of uncertainty in computational fluid dynamics",
/// 1997, section 4: three grids). Errors are the largest deviations over the curve, in the quantity's unit.
struct Convergence
{
   double coarseChange = 0; // between h and h/2
   double fineChange = 0;   // between h/2 and h/4
   double scale = 0;        // largest value of the finest curve: what errors are held against
   /// coarse / fine = 2^order; nothing when either change is lost in rounding.
   std::optional<double> order;
   /// Halving the step divides the change by 2^order with an order that an integrator may have. Else the
   /// runs differ for another reason (chaos, impacts, rounding), and no error can be told from them.
   bool asymptotic = false;
   /// Both changes vanish against the scale: the result no longer depends on the step.
   bool settled = false;

   /// Of a run at h * fraction. Nothing unless asymptotic or settled.
   std::optional<double> errorAt(double fraction) const;
   /// errorAt() over the scale.
   std::optional<double> relativeErrorAt(double fraction) const;
   /// Why there is no error, one sentence; empty when there is one.
   std::string doubt() const;
};

/// Largest |a - b| over the samples both have, up to `until`.
double largestDifference(const History &a, const History &b, double until);
double largestValue(const History &curve, double until);

/// The three curves have the same sample times; only samples up to `until` count.
Convergence convergenceOf(const History &coarse, const History &middle, const History &fine, double until);
/// The same for single values.
Convergence convergenceOf(double coarse, double middle, double fine);

/// What values at cells of edge 1 / times[k] of the first tend to (three resolutions of any ratio), by
/// f = limit + c / times^order. Nothing unless the three approach one limit in order.
struct ResolutionLimit
{
   double limit = 0, order = 0;
};
std::optional<ResolutionLimit> resolutionLimit(const std::array<double, 3> &times,
                                               const std::array<double, 3> &values);

} // namespace diatom
