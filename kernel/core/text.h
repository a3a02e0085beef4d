// Numbers to text and back, never touched by the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace diatom {

/// Shortest text that reads back as the same double; "nan", "inf", "-inf" for the rest.
std::string numberText(double value);
/// Shortest text that reads back as the same single-precision number.
std::string singleText(float value);
/// Exactly `decimals` digits after the point; never "-0.000".
std::string fixedText(double value, int decimals);
/// The whole of `text` as a finite number, else nothing.
std::optional<double> parseNumber(std::string_view text);
std::optional<std::int64_t> parseInteger(std::string_view text);

} // namespace diatom
