// Units of length that 3MF knows (core specification 1.3, 3.4), in metres.
#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace diatom {

inline constexpr std::array<std::pair<double, std::string_view>, 6> kUnits3mf = {{{1e-6, "micron"},
                                                                                  {1e-3, "millimeter"},
                                                                                  {1e-2, "centimeter"},
                                                                                  {25.4e-3, "inch"},
                                                                                  {0.3048, "foot"},
                                                                                  {1, "meter"}}};

} // namespace diatom
