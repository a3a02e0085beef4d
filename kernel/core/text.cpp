#include "core/text.h"

#include <charconv>
#include <cmath>

namespace diatom {

std::string numberText(double value)
{
   char buffer[32];
   const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
   return {buffer, end};
}

std::string singleText(float value)
{
   char buffer[32];
   const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
   return {buffer, end};
}

std::string fixedText(double value, int decimals)
{
   char buffer[400];
   const auto end =
       std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr;
   std::string text(buffer, end);
   if (text.starts_with('-') && text.find_first_of("123456789") == std::string::npos && std::isfinite(value))
      text.erase(0, 1);
   return text;
}

std::optional<double> parseNumber(std::string_view text)
{
   double value = 0;
   const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
   if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      return std::nullopt;
   return value;
}

std::optional<std::int64_t> parseInteger(std::string_view text)
{
   std::int64_t value = 0;
   const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
   if (error != std::errc() || end != text.data() + text.size())
      return std::nullopt;
   return value;
}

} // namespace diatom
