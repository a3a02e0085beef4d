// Which physical effects a scene calls for, why, and with which cells as evidence. An effect that is off
// costs nothing.
#pragma once

#include "cells/hierarchy.h"
#include "scene/networks.h"
#include "scene/setup.h"

#include <optional>
#include <string>
#include <vector>

namespace diatom {

struct Effect
{
   std::string name; // "gravity", "damping", "actuation", ...
   bool on = false;
   bool forced = false;          // by the user, against the planner
   std::string why;              // one sentence
   std::vector<Index> evidence;  // up to a few cells
   std::optional<double> costNs; // per cell-step, where measured
};

/// The effects table applied to a scene, in the table's order.
std::vector<Effect> planEffects(const Hierarchy &hierarchy, const Setup &setup, const Networks &networks);

} // namespace diatom
