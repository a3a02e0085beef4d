// Files of the earlier programs. What they leave open is decided here and said in the notes.
#pragma once

#include "core/job.h"
#include "document/json_place.h"
#include "formats/files.h"

#include <nlohmann/json.hpp>

namespace diatom {

/// AMOEBA assemblies: {"assembly", "materials", "emSim"} with cells under "sparseCells" or "cells".
Opened importAmoeba(const nlohmann::json &file, ReadLog &log, const Job &job);

/// DMDesign assemblies and composites: {"assembly", "materials"} or {"materials"} alone.
Opened importDmdesign(const nlohmann::json &file, ReadLog &log, const Job &job);

/// Dense [x][y][z] arrays with an origin, as both programs write them: calls visit(index, element) for what
/// is not null.
void visitDense(const JsonPlace &array, Index origin,
                const std::function<void(Index, const JsonPlace &)> &visit);

/// {"x": 1, "y": 2, "z": 3}.
Index readXyz(const JsonPlace &place);

/// One note per key that was read past, with its value when short.
void noteUnknown(Opened &opened, const ReadLog &log);

} // namespace diatom
