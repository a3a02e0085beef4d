// Scenes that show what accuracy costs, each with an answer that owes nothing to the solver where there is
// one.
#pragma once

#include "document/design.h"
#include "study/accuracy_study.h"

#include <string>
#include <string_view>
#include <vector>

namespace diatom {

struct AccuracySample
{
   std::string id;   // names its folder
   std::string what; // one sentence for people
   Design design;
   AccuracyRequest request;
};

/// A cantilever's sag, an elastica, the frequency of a bar, a walker's stride, a flexure, and a stiff one.
std::vector<AccuracySample> accuracySamples();

} // namespace diatom
