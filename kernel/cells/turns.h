// Whether a model's orientation and rotation numbers exist on a lattice.
#pragma once

#include "cells/model.h"
#include "core/result.h"
#include "lattice/lattice.h"

namespace diatom {

/// To be asked once when a model meets a lattice: on opening a file, on changing the lattice. The error names
/// the first cell or composite whose number the lattice does not have.
Status checkTurns(const Model &model, const Lattice &lattice);

} // namespace diatom
