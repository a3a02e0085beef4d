// The rows of the stability study, by what they look at.
#pragma once

#include "study/stability_course.h"

#include <functional>
#include <vector>

namespace diatom::stability {

struct Case
{
   std::string id, scene;
   /// Fills in `how`, sizes, checks. Errors: cancelled, or what else kept it from being run.
   std::function<Status(const Bench &bench, StabilityRow &row)> run;
};

std::vector<Case> undampedCases(); // keep energy and momentum
std::vector<Case> settlingCases(); // come to rest, or keep step with what drives them
std::vector<Case> implicitCases(); // do so at steps far beyond the explicit limit
std::vector<Case> bendingCases();  // turns of 90 to 360 degrees
std::vector<Case> limitCases();    // steps at, below and beyond the stable limit

} // namespace diatom::stability
