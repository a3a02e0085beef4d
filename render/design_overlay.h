// What is drawn over a design: the lattice's own tiling on the base plane, the ghost of a cell, the outline
// of a port, a region, the axis triad and, for pictures without widgets, the legend.
#pragma once

#include "lattice/lattice.h"
#include "render/camera.h"
#include "render/lines.h"
#include "render/port_picker.h"

#include <vector>

namespace diatom::render {

/// Outlines, seen from above, of the cells with z index 0 around `content`; faded outwards.
std::vector<Line> baseGrid(const Lattice &lattice, const Box &content, Rgba color);

/// A translucent cell with edges in a colour that says what would happen to it.
void addGhost(Overlay &overlay, const Lattice &lattice, Index cell, Rgba color, Rgba edge);
/// Outline of a port; dead ones (no neighbour, or an occupied one) hatched.
void addPort(Overlay &overlay, const Lattice &lattice, const Port &port, Rgba color, bool dead);
/// Edges of one cell.
void addCellOutline(Overlay &overlay, const Lattice &lattice, Index cell, Rgba color, float width);
/// Box around the cells of a region.
void addRegion(Overlay &overlay, const Lattice &lattice, const Box &region, Rgba color);
/// X, Y and Z at the lower left, turned as the view is.
void addTriad(Overlay &overlay, const Camera &camera);
/// Bar with numbers at the right edge of a picture of the camera's size.
void addLegend(Overlay &overlay, const Camera &camera, const Legend &legend, Rgba ink);

} // namespace diatom::render
