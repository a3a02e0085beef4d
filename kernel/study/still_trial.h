// One timed answer without motion: a quantity at rest from the balance of forces, or a frequency from the
// modes of vibration.
#pragma once

#include "study/trial.h"

#include <cstdint>

namespace diatom {

struct StillTrial
{
   double value = 0;
   std::int64_t iterations = 0; // of Newton's method
   std::int64_t cells = 0;
   double seconds = 0; // wall time, the building of the scene included
};

/// Whether the quantity can be had so: at rest, or a frequency.
bool isStill(const Quantity &quantity);
/// "statics" or "modes", as solvers call it.
Analysis stillAnalysis(const Quantity &quantity);

/// Errors: as solveStatics() and findModes() say; no mode moves the quantity's cell in its direction.
Result<StillTrial> runStill(const Subject &subject, const Values &values, const Quantity &quantity,
                            const Job &job);

/// The subject with every material in use modelled so.
Result<Subject> withCellModel(const Subject &subject, CellModel model, const Job &job);
/// "bond", "block", "solid".
const char *cellModelName(CellModel model);

} // namespace diatom
