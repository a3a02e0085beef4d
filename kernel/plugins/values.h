// Parameter values of a plugin's thing: what a document stores, checked and completed against the manifest.
#pragma once

#include "core/result.h"
#include "plugins/manifest.h"

#include <map>
#include <span>
#include <string>
#include <variant>

namespace diatom {

/// Values by parameter name: numbers in SI or text. Only what differs from the defaults needs to be there.
using Values = std::map<std::string, std::variant<double, std::string>>;

/// All parameters with their values: defaults filled in, ranges, kinds and names checked.
Result<Values> completeValues(std::span<const Parameter> parameters, const Values &given);

} // namespace diatom
