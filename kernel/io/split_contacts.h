// Makes a welded surface a 2-manifold: where solids touch only along an edge or at a corner, each gets
// vertices of its own.
#pragma once

#include "io/solid_mesh.h"

namespace diatom {

/// Expects vertices that are one wherever they coincide, and triangles that enclose a solid. Round an edge
/// with more than two triangles those that bound the same wedge of solid stay together. Where the pieces are
/// still joined at both ends of such an edge, each gets a midpoint of its own. Places do not change. Counts
/// the contacts in the mesh. Refuses a surface that is not closed, naming the first open edge.
Status splitContacts(SolidMesh &mesh);

} // namespace diatom
