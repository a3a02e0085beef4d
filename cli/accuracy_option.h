// --accuracy P of diatom simulate: settings that meet an asked accuracy in the least time, and what became of
// the prediction.
#pragma once

#include "cli/cli.h"
#include "core/result.h"
#include "document/design.h"
#include "study/accuracy_choice.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace diatom::cli {

/// "1%" or "0.01"; above 0 and below 1.
Result<double> parseAccuracy(std::string text);

struct AccuracyAsked
{
   double error = 0;     // relative
   double until = 0;     // s
   std::string quantity; // "X,Y,Z:CHANNEL"; "" = the cell that moves most
   double budget = 30;   // s of wall time that one setting's probe may take at most
   Values fixed;         // solver values that are not to be chosen
};

/// Probes the design and puts what it picks into the set-up. Says on stderr what and why.
Result<AccuracyChoice> applyAccuracy(const AccuracyAsked &asked, const Context::Input &input, Setup &setup,
                                     Context &context);

/// What was asked, found and predicted, beside the wall time (s) that the run took.
nlohmann::ordered_json choiceJson(const AccuracyChoice &choice, double wallSeconds);

} // namespace diatom::cli
