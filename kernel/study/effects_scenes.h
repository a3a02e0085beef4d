// Pairs of scenes that differ in one effect.
#pragma once

#include "document/design.h"

#include <functional>
#include <string>
#include <vector>

namespace diatom {

struct EffectScene
{
   std::string effect;
   std::string what;        // the scene, for people
   Design without;          // has nothing of the effect
   Design calledFor;        // the same, and the effect
   bool byMaterial = false; // the scene is built otherwise for it, and it cannot be switched
   bool nothing = true;     // switched on where nothing calls for it, it contributes nothing
};

/// One for each effect that a solver may have; all are blocks of cells that swing.
std::vector<EffectScene> effectScenes();

} // namespace diatom
