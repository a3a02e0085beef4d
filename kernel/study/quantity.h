// What an error is an error of: one channel of one cell over a run, at one time, at rest, or its frequency.
#pragma once

#include "core/index.h"
#include "core/result.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

struct Quantity
{
   enum class When {
      throughout, // the whole curve up to the end of the run: its largest deviation counts
      atTime,     // the value at `time`
      atRest,     // the value once all motion has died away
      frequency   // Hz, of the curve's swing about its middle
   };

   Index cell;
   std::string channel; // of Simulation::probe()
   When when = When::throughout;
   double time = 0; // s, for atTime

   /// "0,13,0:z", "0,13,0:z@0.05", "0,13,0:z@rest", "0,13,0:z@frequency".
   std::string text() const;
   /// Of the value itself: the channel's, or Hz.
   std::string unit() const;
   friend bool operator==(const Quantity &, const Quantity &) = default;
};

/// Reads text(). Errors: form, channel, time.
Result<Quantity> parseQuantity(std::string_view text);

/// A quantity over one run: times ascend (s).
struct History
{
   std::vector<double> time, value;
};

/// Frequency of a curve, Hz: upward crossings of the middle of its swing, each placed by a line between two
/// samples. Nothing when it crosses fewer than twice.
std::optional<double> historyFrequency(const History &curve);

} // namespace diatom
