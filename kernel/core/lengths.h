// Lengths as people write them: a number and a unit.
#pragma once

#include "core/text.h"

#include <array>
#include <optional>
#include <string_view>
#include <utility>

namespace diatom {

/// Names and metres. A name that ends with another comes before it.
inline constexpr std::array<std::pair<std::string_view, double>, 6> kLengthUnits = {
    {{"mm", 1e-3}, {"cm", 1e-2}, {"um", 1e-6}, {"nm", 1e-9}, {"in", 25.4e-3}, {"m", 1}}};

/// "2.5mm", "0.1 in", "mm" for one of them; a number alone is in `metres`. Nothing when it is no length above
/// 0.
inline std::optional<double> parseLength(std::string_view text, double metres = 1)
{
   for (const auto &[name, unit] : kLengthUnits)
      if (text.ends_with(name)) {
         text.remove_suffix(name.size());
         metres = unit;
         if (text.empty())
            return metres;
         break;
      }
   while (text.ends_with(' '))
      text.remove_suffix(1);
   const auto number = parseNumber(text);
   return number && *number > 0 ? std::optional(*number * metres) : std::nullopt;
}

} // namespace diatom
