// The surface of a design as a solver left it: STL with every corner where its cells have taken it.
#pragma once

#include "cells/hierarchy.h"
#include "io/stl.h"
#include "scene/solver_run.h"

#include <filesystem>

namespace diatom::cli {

/// A corner that several cells share lies at the mean of where each of them puts it, so that the surface
/// stays closed. `scale` exaggerates: displacements are multiplied by it.
Result<StlReport> writeDeformedStl(const Hierarchy &hierarchy, const SolverRun &run, double scale,
                                   const std::filesystem::path &file, const Job &job);

} // namespace diatom::cli
