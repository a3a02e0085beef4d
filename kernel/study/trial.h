// One timed run of a scene with given settings: the curve of a quantity, and what it cost.
#pragma once

#include "cells/hierarchy.h"
#include "core/job.h"
#include "core/result.h"
#include "plugins/catalogue.h"
#include "scene/setup.h"
#include "scene/simulation.h"
#include "study/quantity.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace diatom {

/// A scene that trials are made of. Cheap to copy.
struct Subject
{
   std::shared_ptr<const Catalogue> catalogue;
   std::shared_ptr<const Hierarchy> hierarchy;
   Setup setup;
   /// Cells along an edge that each of the design's cells was cut into; a quantity is the mean over the parts
   /// of its cell.
   int resolution = 1;
};

/// Numbers of the cells that make up the quantity's cell. Errors: one is not there.
Result<std::vector<std::int64_t>> quantityCells(const Subject &subject, const Quantity &quantity,
                                                const Scene &scene);

/// A run with the set-up's solver values overridden by `values`, at most `step` long steps (s; 0 = the
/// solver's own).
Result<std::unique_ptr<Simulation>> startTrial(const Subject &subject, const Values &values, double step,
                                               const Job &job);

struct TrialRun
{
   History curve;
   double step = 0;        // s, in use
   std::int64_t steps = 0; // done
   std::int64_t cells = 0;
   double seconds = 0;     // wall time of building the scene and of stepping
   double stepSeconds = 0; // wall time of one step: the median over the samples' stretches
   double nsPerCellStep() const { return cells > 0 ? 1e9 * stepSeconds / static_cast<double>(cells) : 0; }
};

/// Steps through `samples` equal stretches of `until`, each in `perSample` equal steps, and records the
/// quantity at the end of each.
Result<TrialRun> runTrial(const Subject &subject, const Values &values, const Quantity &quantity,
                          double until, std::int64_t samples, std::int64_t perSample, const Job &job);

/// Wall time (s) of one step of the given length (s): the median over stretches of the run to `until` that
/// are long enough to time, as many as fit into `seconds`.
Result<double> timeStep(const Subject &subject, const Values &values, double step, double until,
                        double seconds, const Job &job);

/// Mean length (s) of the steps that a solver without a stable limit chooses for itself, up to `until` or as
/// far as it comes in `seconds` of wall time.
Result<double> ownStep(const Subject &subject, const Values &values, double until, double seconds,
                       const Job &job);

/// Median; 0 of nothing.
double median(std::vector<double> values);

} // namespace diatom
