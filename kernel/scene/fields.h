// Inputs of solvers that Diatom itself knows nothing of, as a solver of heat takes temperatures: set by name
// on cells, handed on by name.
#pragma once

#include "scene/boundary.h"
#include "scene/networks.h"
#include "scene/setup.h"

#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// Names of the set-up's fields, each once, ascending.
std::vector<std::string> fieldNames(const Setup &setup);

/// What is wrong with a field: "" or the rest of a sentence, like "has no values".
std::string fieldFault(const Field &field);

/// Errors "bad-field", each naming its cells; also where two fields of a name have different numbers of
/// values.
void findBadFields(std::vector<Problem> &problems, const Setup &setup);

/// The channel of a field: a row for each of an entry's cells, entries in their order, so that a cell can
/// have several.
ChannelRows fieldChannel(const Scene &scene, const Setup &setup, std::string_view name);

} // namespace diatom
