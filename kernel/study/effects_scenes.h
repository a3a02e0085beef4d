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
   bool byMaterial = false; // the material asks for it: the scene is built otherwise, and cannot be switched
};

/// One for each effect that a solver may have; all are blocks of cells that swing.
std::vector<EffectScene> effectScenes();

} // namespace diatom
