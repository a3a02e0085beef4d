// The settings a solver can be run at, read from its own declaration: an integrator or a precision that a
// solver adds turns up here by itself.
#pragma once

#include "plugins/catalogue.h"
#include "plugins/values.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// A choice parameter of a solver that accuracy or cost may depend on.
struct Choice
{
   std::string name;
   std::vector<std::string> choices; // the first is the one the scene would use
};

/// Those of `wanted` that the solver declares as choices, in that order; each choice that the scene's values
/// or else the solver's default name comes first.
std::vector<Choice> solverChoices(const Catalogue &catalogue, const std::string &solver, const Values &inUse,
                                  std::span<const std::string_view> wanted);

/// All combinations as solver values, those with fewest choices unlike the scene's first.
std::vector<Values> combinations(const std::vector<Choice> &choices);

/// "verlet f32 simple": the choices' values in order.
std::string settingText(const std::vector<Choice> &choices, const Values &values);

} // namespace diatom
