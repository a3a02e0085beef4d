// How the commands about scenes write indices, problems and effects as JSON, and read them from options.
#pragma once

#include "cli/cli.h"
#include "core/result.h"
#include "document/design.h"
#include "scene/effects.h"
#include "scene/networks.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace diatom::cli {

nlohmann::ordered_json toJson(Index index);
nlohmann::ordered_json toJson(const std::vector<Index> &cells);
nlohmann::ordered_json toJson(const std::vector<Problem> &problems);
nlohmann::ordered_json toJson(const std::vector<Effect> &effects);
const char *waveformName(Waveform waveform);

bool hasErrors(const std::vector<Problem> &problems);

/// "X,Y,Z".
Result<Index> parseIndex(const std::string &text);
/// "auto" or "+name,-name": what the user switches on and off.
Status applyEffects(const std::string &text, Setup &setup);
/// "path=value": drag, step, gravity.x, ground.height, materials.ID.density, ... or solver.NAME.
Status applySetting(const std::string &text, Design &design);

} // namespace diatom::cli
