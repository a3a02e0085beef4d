// Which bond sets the stable step, and what its kind costs: the one thing a user can change about it.
#pragma once

#include "study/trial.h"

#include <optional>
#include <string>

namespace diatom {

/// Of the stable step, where a walk through step lengths begins: as the solvers' own choice.
inline constexpr double kCoarsestStep = 0.9;
/// Solvers that no step can upset choose theirs by the motion: at most this many of them are tried.
inline constexpr double kMostOwnSteps = 4;

struct StepLimit
{
   double stableStep = 0;            // s; 0 when the solver has no limit
   bool hasBond = false;             // a bond sets it, not a contact or drag
   Index a, b;                       // of that bond
   std::string materialA, materialB; // ids
   /// How many times longer the step could be without bonds of these two materials; nothing when there are no
   /// others.
   std::optional<double> gainWithout;
   /// "the bond (3, 1, 4)-(4, 1, 4), steel/rubber"; "" without a bond.
   std::string text() const;
};

/// Asks the solver; runs nothing.
Result<StepLimit> findStepLimit(const Subject &subject, const Values &values, const Job &job);

} // namespace diatom
