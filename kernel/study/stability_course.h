// A hard case as it runs: what its energy, its momentum and its motion did.
#pragma once

#include "document/design.h"
#include "scene/simulation.h"
#include "study/stability_study.h"

#include <cstdint>
#include <optional>
#include <string>

namespace diatom::stability {

/// Where rows are run.
struct Bench
{
   const std::shared_ptr<const Catalogue> &catalogue;
   bool longForm;
   const Job &job;

   std::int64_t steps(std::int64_t brief, std::int64_t full) const { return longForm ? full : brief; }
   std::int32_t edge(std::int32_t brief, std::int32_t full) const { return longForm ? full : brief; }
};

struct Settings
{
   std::string integrator = "semi_implicit";
   double ofLimit = 0.9; // step over the stable one
   double step = 0;      // s; 0 = by ofLimit
   bool force = false;   // also beyond the limit
   std::string precision = "f64";
   std::string text() const;
};

/// Extremes over samples taken evenly through a run.
struct Course
{
   std::int64_t cells = 0, steps = 0;
   double step = 0, time = 0;      // s
   double mass = 0;                // kg
   double travel = 0;              // m: how far the centre of mass goes
   Energy start, end;              //
   double mostEnergy = 0;          // J, stored less the gravity at the start
   double mostKinetic = 0;         // J
   double drift = 0;               // largest |Energy::drift|
   double unaccounted = 0;         // at the end: energy that came from nowhere, over all that went through
   double linear = 0, angular = 0; // largest change of momentum, over what the motion has to give
   double firstTenth = 0, lastTenth = 0; // J: mean stored energy there
   std::optional<Error> stopped;         // by divergence
   std::int64_t lost = 0;                // steps from the last good state to the stop
};

/// Runs `steps` steps and looks `samples` times. With `dense`, every step of the first and the last tenth is
/// looked at instead, so that no tone of the motion is mistaken for a drift.
Result<Course> follow(const Bench &bench, const Design &design, const Settings &settings, std::int64_t steps,
                      std::int64_t samples, bool dense = false);

/// A simulation of the design, for rows that look at it themselves.
Result<std::unique_ptr<Simulation>> begin(const Bench &bench, const Design &design, const Settings &settings);

/// Fills in what every row tells of a course.
void tell(const Course &course, const Settings &settings, StabilityRow &row);

} // namespace diatom::stability
