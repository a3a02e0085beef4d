// Integrators that take a step in stages, each from the start of the step (Hairer, Norsett and Wanner,
// Solving Ordinary Differential Equations I, 1993, section II.1): Butcher's tables, of which each stage needs
// the one before it alone.
#pragma once

#include "model/assembly.h"

#include <span>

namespace bonds {

/// Parts of a step: where the stage's forces act, where the next one's will, and what they weigh in the step.
struct Stage
{
   double ahead = 0, next = 0, weight = 0;
};

/// Empty for integrators without stages.
inline std::span<const Stage> stagesOf(Options::Integrator integrator)
{
   static constexpr Stage rungeKutta[] = {
       {0, 0.5, 1.0 / 6}, {0.5, 0.5, 1.0 / 3}, {0.5, 1, 1.0 / 3}, {1, 0, 1.0 / 6}};
   static constexpr Stage midpoint[] = {{0, 0.5, 0}, {0.5, 0, 1}};
   static constexpr Stage forwardEuler[] = {{0, 0, 1}};
   switch (integrator) {
   case Options::Integrator::rungeKutta:
      return rungeKutta;
   case Options::Integrator::midpoint:
      return midpoint;
   case Options::Integrator::forwardEuler:
      return forwardEuler;
   default:
      return {};
   }
}

} // namespace bonds
