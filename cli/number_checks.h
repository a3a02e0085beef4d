// Checks of numbers that CLI11's own do not make: not a number, and infinite.
#pragma once

#include <CLI/CLI.hpp>

#include <cmath>
#include <string>

namespace diatom::cli {

inline CLI::Validator numberCheck(const char *name, const char *wants, bool (*holds)(double))
{
   return {[wants, holds](std::string &text) -> std::string {
              double value = 0;
              if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && holds(value))
                 return {};
              return "\"" + text + "\" is not " + wants;
           },
           name};
}

inline const CLI::Validator kPositive =
    numberCheck("POSITIVE", "a number above 0", [](double value) { return value > 0; });
inline const CLI::Validator kNonNegative =
    numberCheck("NONNEGATIVE", "a number of 0 or more", [](double value) { return value >= 0; });

} // namespace diatom::cli
