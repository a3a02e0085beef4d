#include "render/color_map.h"

#include "core/text.h"

#include <algorithm>
#include <cmath>

namespace diatom::render {

namespace {

/// Oklab to sRGB (B. Ottosson, "A perceptual color space for image processing", 2020).
std::array<double, 3> oklabToSrgb(double lightness, double a, double b)
{
   const double l = lightness + 0.3963377774 * a + 0.2158037573 * b;
   const double m = lightness - 0.1055613458 * a - 0.0638541728 * b;
   const double s = lightness - 0.0894841775 * a - 1.2914855480 * b;
   const double l3 = l * l * l, m3 = m * m * m, s3 = s * s * s;
   const std::array<double, 3> linear{4.0767416621 * l3 - 3.3077115913 * m3 + 0.2309699292 * s3,
                                      -1.2684380046 * l3 + 2.6097574011 * m3 - 0.3413193965 * s3,
                                      -0.0041960863 * l3 - 0.7034186147 * m3 + 1.7076147010 * s3};
   std::array<double, 3> srgb{};
   for (std::size_t i = 0; i < 3; ++i) {
      const double v = std::clamp(linear[i], 0.0, 1.0);
      srgb[i] = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
   }
   return srgb;
}

} // namespace

Rgba fieldColor(double fraction)
{
   if (!std::isfinite(fraction))
      return {128, 128, 128, 255};
   const double t = std::clamp(fraction, 0.0, 1.0);
   // Straight in lightness; hue turns from blue-violet (290 degrees) through teal and green to yellow (105);
   // chroma is what sRGB can show along that path.
   const double lightness = 0.30 + 0.62 * t;
   const double hue = (290 - 185 * t) * 3.14159265358979323846 / 180;
   const double chroma = 0.10 + 0.07 * t - 0.04 * std::sin(3.14159265358979323846 * t);
   const auto srgb = oklabToSrgb(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
   const auto byte = [](double v) { return static_cast<std::uint8_t>(std::lround(255 * v)); };
   return {byte(srgb[0]), byte(srgb[1]), byte(srgb[2]), 255};
}

Legend fieldLegend(const std::string &name, const std::string &unit, double low, double high)
{
   Legend legend;
   legend.title = unit.empty() ? name : name + " (" + unit + ")";
   legend.low = legend.high = low;
   if (!(high > low) || !std::isfinite(high - low)) {
      legend.ticks = {low};
      legend.texts = {numberText(low)};
      return legend;
   }
   legend.high = high;
   // Steps 1, 2, 5 times a power of ten, at most six of them.
   const double raw = (high - low) / 5;
   const int decade = static_cast<int>(std::floor(std::log10(raw)));
   const double power = std::pow(10.0, decade);
   const double mantissa = raw / power;
   const double step = (mantissa <= 1 ? 1 : mantissa <= 2 ? 2 : mantissa <= 5 ? 5 : 10) * power;
   const int decimals = std::max(0, step >= 9.99 * power ? -(decade + 1) : -decade);
   for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * (high - low); ++i) {
      legend.ticks.push_back(i * step);
      legend.texts.push_back(fixedText(i * step, decimals));
   }
   return legend;
}

Legend lengthLegend(const std::string &name, double highest)
{
   const bool micro = highest > 0 && highest < 0.5e-3;
   const double high = std::isfinite(highest) ? highest * (micro ? 1e6 : 1e3) : 0;
   return fieldLegend(name, micro ? "um" : "mm", 0, high);
}

Magnitudes displacementMagnitudes(std::span<const double> position, std::span<const double> rest)
{
   Magnitudes result;
   const std::size_t count = std::min(position.size(), rest.size()) / 3;
   result.values.resize(count);
   for (std::size_t i = 0; i < count; ++i) {
      const double x = position[3 * i] - rest[3 * i], y = position[3 * i + 1] - rest[3 * i + 1],
                   z = position[3 * i + 2] - rest[3 * i + 2];
      result.values[i] = std::sqrt(x * x + y * y + z * z);
      result.highest = std::max(result.highest, result.values[i]);
   }
   return result;
}

} // namespace diatom::render
