// How thick the struts of a design can be before joints use up whole struts or struts run into each other.
#pragma once

#include "io/strut_graph.h"

namespace diatom {

struct StrutLimit
{
   double radius = 0; // m, of the circle round the section
   Vec3 where = Vec3::Zero();
   bool crossing = false; // struts or joints that share no node are what limits
};

/// Per node: how far its end polygons stand from it, in radii; 0 for free ends.
std::vector<double> setBacks(const StrutGraph &graph);
Result<StrutLimit> strutLimit(const StrutGraph &graph, const std::vector<double> &setBacks, const Job &job);

} // namespace diatom
