// Options that are lengths.
#pragma once

#include "core/lengths.h"

#include <CLI/CLI.hpp>

#include <string>

namespace diatom::cli {

/// Turns a length option into metres before it is read as a number.
inline const CLI::Validator kLength(
    [](std::string &text) -> std::string {
       const auto metres = parseLength(text);
       if (!metres)
          return "\"" + text + "\" is not a length above 0, such as 2mm";
       text = numberText(*metres);
       return {};
    },
    "LENGTH");

} // namespace diatom::cli
