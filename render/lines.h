// Lines and translucent solids drawn over the cells: grid, outlines, ghost, region, axis triad, legend.
#pragma once

#include "core/vec.h"
#include "render/color_map.h"

#include <Eigen/Core>

#include <span>
#include <string_view>
#include <vector>

namespace diatom::render {

/// A straight line of constant width in pixels; world metres, or pixels from the top left for screen lines (z
/// unused).
struct Line
{
   Vec3 a = Vec3::Zero(), b = Vec3::Zero();
   Rgba color;
   float width = 1;
};

/// A flat convex polygon, counter-clockwise from the side it is seen from.
struct Polygon
{
   std::vector<Vec3> corners;
   Rgba color;
};

/// Everything over the scene. Cheap to make anew for each movement of the pointer.
struct Overlay
{
   std::vector<Polygon> ghost;      // hidden parts shine through faintly
   std::vector<Line> lines;         // likewise
   std::vector<Polygon> screenFill; // pixels
   std::vector<Line> screenLines;   // pixels
};

/// Closed polygon as lines.
void addLoop(std::vector<Line> &lines, std::span<const Vec3> corners, Rgba color, float width);
/// Parallel strokes across a polygon, `spacing` metres apart: reads as "not here" without relying on colour.
void addHatch(std::vector<Line> &lines, std::span<const Vec3> corners, double spacing, Rgba color,
              float width);
/// Twelve edges of an axis-aligned box.
void addBox(std::vector<Line> &lines, const Vec3 &low, const Vec3 &high, Rgba color, float width);
/// Text in strokes: (0-9 a-z ( ) . - = X Y Z), `size` pixels high, top left at `at`. Unknown characters are
/// gaps.
void addText(std::vector<Line> &lines, std::string_view text, const Eigen::Vector2d &at, double size,
             Rgba color, float width);
/// Width of addText() in pixels.
double textWidth(std::string_view text, double size);

} // namespace diatom::render
