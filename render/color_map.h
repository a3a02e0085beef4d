// A perceptual colour map for fields: lightness rises evenly from deep blue through green to yellow, so that
// the order of values survives grey printing and colour blindness. Also the round numbers a legend shows.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace diatom::render {

/// Colour bytes, opaque unless said otherwise.
struct Rgba
{
   std::uint8_t r = 0, g = 0, b = 0, a = 255;
   friend bool operator==(const Rgba &, const Rgba &) = default;
};

/// Colour of a fraction 0 to 1; values outside are clamped, not-a-number is grey.
Rgba fieldColor(double fraction);

/// What a legend shows: the range, and the field's name with its unit.
struct Legend
{
   std::string title;              // "displacement (mm)"
   double low = 0, high = 0;       // in the unit of the title
   std::vector<double> ticks;      // round numbers within the range, rising
   std::vector<std::string> texts; // of the ticks
};

/// A legend for values of any unit, with round ticks between the two; equal ones: one tick.
Legend fieldLegend(const std::string &name, const std::string &unit, double low, double high);

/// A legend for values in metres from 0 to `highest`; picks mm or um and round ticks. Zero range: one tick.
Legend lengthLegend(const std::string &name, double highest);

/// Lengths of 3-vectors laid out x y z, and the largest of them.
struct Magnitudes
{
   std::vector<double> values;
   double highest = 0;
};
Magnitudes displacementMagnitudes(std::span<const double> position, std::span<const double> rest);

} // namespace diatom::render
