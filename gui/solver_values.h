// A solver's values in the set-up, changed: as few as differ from the solver's defaults.
#pragma once

#include "plugins/catalogue.h"
#include "scene/setup.h"

#include <nlohmann/json.hpp>

namespace diatom::gui {

/// The set-up's values with some changed; those that the solver has by default are left out.
Values mergedValues(const Catalogue &catalogue, const Setup &setup, const Values &changed);
/// As the command set-solver takes them.
nlohmann::json valuesArgument(const Values &values);
/// Part of the stable step that the solver takes by itself: its parameter "safety", else nine tenths.
double automaticFraction(const Catalogue &catalogue, const Setup &setup);

} // namespace diatom::gui
