// What the accuracy page finds out about a design, away from the window.
#pragma once

#include "study/accuracy_choice.h"

namespace diatom::gui {

/// s: as the design says; else long enough to see it move and turn back; else, where that cannot be seen
/// soon, one second.
Result<double> lengthToProbe(const Subject &subject, const Job &job);
Result<AccuracyProbe> probeDesign(const Subject &subject, const Job &job);
/// `error` is relative.
Result<AccuracyChoice> chooseForDesign(const Subject &subject, double error, const Job &job);

/// Whether a probe of one set-up tells of the other: all that a run depends on but the step.
bool sameButStep(const Setup &a, const Setup &b);

} // namespace diatom::gui
