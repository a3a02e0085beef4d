// The cheapest settings that meet an asked accuracy on a scene, found by probing it.
#pragma once

#include "study/accuracy_probe.h"

#include <optional>
#include <string>
#include <vector>

namespace diatom {

struct ChoiceRequest
{
   double until = 0;                 // s, the run
   double error = 0.01;              // relative, to stay within
   std::optional<Quantity> quantity; // nothing = the cell that moves most
   /// Settings that are not to be changed, beside those of the set-up that nothing chooses.
   Values fixed;
   double budget = 30; // s of wall time that one setting's probe may take at most
};

/// One way to run the scene, and what its probe told.
struct SettingOption
{
   std::string setting; // settingText()
   Values values;
   double step = 0;                    // s, the longest that meets the request; 0 when there is none
   Estimate error;                     // at that step, of the whole run
   double withinError = 0, window = 0; // at that step, over the part of the run that was tried (s)
   Estimate seconds;                   // the run takes
   std::string note;                   // why it is out of the question; empty when it is not
};

struct AccuracyChoice
{
   Quantity quantity;
   double error = 0; // asked
   std::vector<SettingOption> candidates;
   std::size_t picked = 0; // of the candidates; has a step
   std::string why;        // one sentence
   double probeSeconds = 0;

   const SettingOption &best() const { return candidates[picked]; }
};

/// Errors: as a run's own; no setting converges as the step shrinks, with the reason; cancelled.
Result<AccuracyChoice> chooseForAccuracy(const Subject &subject, const ChoiceRequest &request,
                                         const Job &job);

} // namespace diatom
