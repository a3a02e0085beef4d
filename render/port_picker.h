// Which port of which cell lies under the pointer, and which cell a click would put there. A port is where a
// neighbour attaches: a face, an edge or a vertex, as the lattice says; nothing here knows any particular
// lattice.
#pragma once

#include "cells/hierarchy.h"
#include "render/camera.h"

#include <optional>
#include <string>
#include <vector>

namespace diatom::render {

struct Port
{
   Index cell; // that has the port; for the base plane the cell that would be placed
   Contact contact = Contact::face;
   int feature = 0;                // face, edge or vertex number of the cell's shape
   std::optional<Index> neighbour; // where it leads; nothing when no cell of the lattice meets it
   bool occupied = false;          // a cell is there already
   bool base = false;              // of the base plane, a virtual layer under the cells with z index 0

   /// "(4,2,7) face 9", "(0,0,0) base plane".
   std::string text() const;
   friend bool operator==(const Port &, const Port &) = default;
};

struct Pick
{
   Port port;
   std::optional<RayHit> hit; // nothing on the base plane
   double distance = 0;       // m along the ray
};

/// The port under a ray: of the first cell hit, else of the base plane. Nothing when the ray meets neither.
std::optional<Pick> pickPort(const Hierarchy &hierarchy, const Ray &ray, double reach);

/// All ports of a cell that lead somewhere, hidden ones included, in the lattice's order.
std::vector<Port> portsOf(const Hierarchy &hierarchy, Index cell);

/// The next port of the same cell with a free place behind it, `steps` on; the same port when there is none.
Port cyclePort(const Hierarchy &hierarchy, const Port &from, int steps);

/// Corners of the port: a polygon, two ends of an edge, or one vertex; m.
std::vector<Vec3> portOutline(const Lattice &lattice, const Port &port);

/// Height of the plane the cells with z index 0 rest on, m.
double basePlaneHeight(const Lattice &lattice);
/// The cell with z index `layer` whose centre is nearest, seen from above.
Index cellOfLayer(const Lattice &lattice, const Vec3 &point, std::int32_t layer);
/// Height from a layer to the next, averaged over a period, m.
double layerHeight(const Lattice &lattice);
/// Where a ray meets the horizontal plane through `height`; nothing when it runs along or away from it.
std::optional<Vec3> meetPlane(const Ray &ray, double height);

/// "(4,2,7)"
std::string text(Index i);

} // namespace diatom::render
