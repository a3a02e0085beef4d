// What the runs of an accuracy study tell: the reference, the errors against it, and which setting to take.
#pragma once

#include "study/accuracy_runs.h"

namespace diatom {

/// Everything but the sensitivity.
AccuracyStudy judgeRuns(AccuracyRuns &runs);

/// How much more the quantity changes than the density of all that the scene is made of, at the solver's own
/// step.
Result<double> sensitivityOf(const Subject &subject, const AccuracyPlan &plan, const Job &job);

} // namespace diatom
