// What a scene calls for beside its bonds.
#pragma once

#include "model/coupling.h"

namespace bonds {

/// Empty where no material is a solid and no one asked for Poisson's ratio. The assembly must outlive it.
Couplings makeCouplings(const sdk::SceneView &scene, const Assembly &assembly);

} // namespace bonds
