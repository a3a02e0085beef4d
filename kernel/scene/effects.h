// Which physical effects a scene calls for, why, and with which cells as evidence. An effect that is off
// costs nothing.
#pragma once

#include "cells/hierarchy.h"
#include "scene/analysis.h"
#include "scene/networks.h"
#include "scene/setup.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

struct Effect
{
   std::string name; // "gravity", "damping", "actuation", ...
   bool on = false;
   bool forced = false;          // the user said on or off, whatever the planner found
   std::string why;              // one sentence
   std::vector<Index> evidence;  // up to a few cells
   std::optional<double> costNs; // per cell-step, where measured
};

/// The effects table applied to a scene, in the table's order, then the names of the set-up's fields. An
/// effect that this version cannot do is never on, even when asked for: `forced` then says that it was, and
/// `why` that it cannot be had.
std::vector<Effect> planEffects(const Hierarchy &hierarchy, const Setup &setup, const Networks &networks,
                                Analysis analysis = Analysis::dynamics);

/// Names of the table's effects, in order.
std::vector<std::string> effectNames();
/// Whether it is one of mechanics: of the table, not a field.
bool effectIsMechanical(std::string_view name);
/// Whether a solver is told of the effect by name; the others are settled while the scene is built.
bool effectIsForSolver(std::string_view name);

/// Whether a material has a Poisson's ratio that its bonds leave out, so that the effect "poisson" can add
/// it: solid elements have it in themselves, and bond constants of one's own have none.
bool bondsLeaveRatioOut(const Material &material);

} // namespace diatom
