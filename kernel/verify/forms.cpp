#include "verify/forms.h"

namespace diatom {

namespace {

constexpr const char *kElectronics = "circuits in full are not simulated yet";

constexpr Form kForms[] = {
    {"design", "quantities of a design as it is saved", answerDesign},
    {"single-bond", "forces of one bond in given states", answerSingleBond},
    {"bond-invariants", "balance, frame indifference and closed-loop work of one bond", answerBondInvariants},
    {"cantilever", "chains under small loads", answerCantilever},
    {"composite-bonds", "chains of unlike cells", answerCompositeBonds},
    {"elastica-tip-force", "chains bent far by a force", answerElastica},
    {"end-moment", "chains rolled up by a moment", answerEndMoment},
    {"twist-helix", "chains twisted far", answerTwistHelix},
    {"right-angle-frame", "an L bent far out of its plane", answerRightAngleFrame},
    {"bend-45deg", "an actuated arc bent out of its plane", answerBend45},
    {"column-buckling", "critical loads of columns", answerColumnBuckling},
    {"lee-frame", "a frame's first limit load", answerLeeFrame},
    {"cantilever-modes", "frequencies of chains", answerCantileverModes},
    {"free-block", "frequencies of a free block", answerFreeBlock},
    {"actuated-shapes", "rings and helices of actuators", answerActuatedShapes},
    {"time-step-limits", "highest frequencies of blocks and the steps they allow", answerTimeStepLimits},
    {"damping", "damped oscillators and a released chain", answerDamping},
    {"conservation", "free bodies that spin", answerConservation},
    {"contact-friction", "cells that fall, slide, stick and stand", answerContact},
    {"space-frame", "a frame of anisotropic, turned cells", answerSpaceFrame},
    {"shear-flexure", "the flexure of thesis figure 7-4", answerShearFlexure},
    {"bimorph", "the bending actuator of thesis figure 7-5", answerBimorph},
    {"homogenisation", "blocks between rigid plates", answerHomogenisation},
    {"accuracy-ladder", "errors of the models, from the cases beside it", answerAccuracyLadder},
    {"circuits", "resistors, capacitors and oscillators", nullptr, kElectronics},
    {"circuit-verdicts", "circuits to be accepted or refused", nullptr, kElectronics},
    {"potential-field", "fields between conductors", nullptr, kElectronics},
    {"electromechanical-chain", "an oscillator that drives actuators", nullptr, kElectronics},
};

} // namespace

std::span<const Form> verificationForms() { return kForms; }

} // namespace diatom
