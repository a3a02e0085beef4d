// The forms of cases: what each asks, and the function that answers it with the solver.
#pragma once

#include "verify/case_scene.h"
#include "verify/findings.h"

#include <span>
#include <string_view>

namespace diatom {

struct Form
{
   const char *name;
   const char *asks;
   /// Answers a case; null where no solver here does yet. Errors: of a case that lacks what its form needs,
   /// or cancelled. Where the solver fails, the values in question fail.
   Status (*answer)(const Case &one, const Bench &bench, Findings &findings);
   const char *later = ""; // what has to come first, where there is no answer
};

std::span<const Form> verificationForms();

/// What the cases of figures 7-4 and 7-5 look like, without a load.
CaseScene flexureScene(const Case &one);
CaseScene bimorphScene(const Case &one, double strain);

// One file for each family.
Status answerDesign(const Case &one, const Bench &bench, Findings &findings);
Status answerSingleBond(const Case &one, const Bench &bench, Findings &findings);
Status answerBondInvariants(const Case &one, const Bench &bench, Findings &findings);
Status answerCantilever(const Case &one, const Bench &bench, Findings &findings);
Status answerCompositeBonds(const Case &one, const Bench &bench, Findings &findings);
Status answerElastica(const Case &one, const Bench &bench, Findings &findings);
Status answerEndMoment(const Case &one, const Bench &bench, Findings &findings);
Status answerTwistHelix(const Case &one, const Bench &bench, Findings &findings);
Status answerRightAngleFrame(const Case &one, const Bench &bench, Findings &findings);
Status answerColumnBuckling(const Case &one, const Bench &bench, Findings &findings);
Status answerLeeFrame(const Case &one, const Bench &bench, Findings &findings);
Status answerBend45(const Case &one, const Bench &bench, Findings &findings);
Status answerActuatedShapes(const Case &one, const Bench &bench, Findings &findings);
Status answerCantileverModes(const Case &one, const Bench &bench, Findings &findings);
Status answerFreeBlock(const Case &one, const Bench &bench, Findings &findings);
Status answerTimeStepLimits(const Case &one, const Bench &bench, Findings &findings);
Status answerDamping(const Case &one, const Bench &bench, Findings &findings);
Status answerConservation(const Case &one, const Bench &bench, Findings &findings);
Status answerContact(const Case &one, const Bench &bench, Findings &findings);
Status answerSpaceFrame(const Case &one, const Bench &bench, Findings &findings);
Status answerShearFlexure(const Case &one, const Bench &bench, Findings &findings);
Status answerBimorph(const Case &one, const Bench &bench, Findings &findings);
Status answerHomogenisation(const Case &one, const Bench &bench, Findings &findings);
Status answerAccuracyLadder(const Case &one, const Bench &bench, Findings &findings);

} // namespace diatom
