// What a solver hands over, looked at before anything relies on it. Each returns the first fault, or "".
#pragma once

#include "scene/scene.h"

#include <diatom/abi/solver.h>

#include <span>
#include <string>

namespace diatom {

/// Names, counts and strides; those of known outputs fit the scene.
std::string faultOfOutputs(const diatom_outputs &outputs, const Scene &scene);
/// Rows of an output from row `first`: all finite.
std::string faultOfRows(std::span<const double> values, const std::string &output, std::int64_t first,
                        std::int64_t stride, std::int64_t rows, const Scene &scene);
/// A step that says it succeeded.
std::string faultOfStep(const diatom_step_result &result);

} // namespace diatom
