// The host's side of a worker: a solver that runs in a process of its own, behind the same table as one in
// this process.
#pragma once

#include "plugins/manifest.h"

#include <diatom/abi/solver.h>

#include <string>

namespace diatom {

/// The table through which `id` of this plugin is used in a worker. A crash of it is an error of the call
/// that ran; one that does not stop within ten seconds of being cancelled is ended. Any thread.
const diatom_solver *workerSolver(const Manifest &manifest, const std::string &id);

} // namespace diatom
