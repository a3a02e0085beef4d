// What the supports, drives, loads and starts of a set-up mean for each cell, as a solver's channels.
#pragma once

#include "scene/setup.h"

#include <cstdint>
#include <string>
#include <vector>

namespace diatom {

class Scene;

/// `stride` numbers for each place; without places one row for the whole scene (see diatom_channel).
struct ChannelRows
{
   std::string name;
   std::int64_t stride = 1;
   std::vector<std::int64_t> where;
   std::vector<double> values;
};

struct BoundaryWanted
{
   bool driven = false, loads = false; // the effects of these names
   bool velocity = false;              // false for analyses without motion
};

/// Channels fixed, driven, curve, force, velocity and pose of a scene whose cells and materials are set; one
/// that says nothing is left out, except for the channels of effects that are on. The set-up has no problems.
std::vector<ChannelRows> boundaryChannels(const Scene &scene, const Setup &setup, BoundaryWanted wanted);

} // namespace diatom
