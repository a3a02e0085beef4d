// How long a scene must be watched to see what it does.
#pragma once

#include "study/trial.h"

namespace diatom {

/// s: one period of the slowest source that drives something; else until the motion, starting at rest, has
/// come to a stop twice (out and back), told by its kinetic energy; else, where it does not stop within 20
/// 000 steps, that long. Errors: as a run's own.
Result<double> motionTime(const Subject &subject, const Job &job);

} // namespace diatom
