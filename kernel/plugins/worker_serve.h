// The worker's side: a solver from outside in a process of its own.
#pragma once

#include "plugins/shared_memory.h"

namespace diatom {

/// Answers requests until the host closes the line; returns the exit status of the process. One solver per
/// worker.
int serveSolver(Line line);

} // namespace diatom
