// What is wrong with a state whose turns were taken to be small and are not.
#pragma once

#include "model/state.h"

#include <functional>
#include <optional>
#include <string>

namespace bonds {

/// A sentence for the user; none where no strain is wrong by a thousandth, or where turns count in full.
/// `name` tells a bond.
std::optional<std::string> largeTurnsIn(const Assembly &assembly, const State &state,
                                        const std::function<std::string(std::int64_t bond)> &name);

} // namespace bonds
