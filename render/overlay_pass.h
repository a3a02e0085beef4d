// Draws lines, translucent polygons and boxes. For the .cpp files of render/ only.
#pragma once

#include "render/composite_boxes.h"
#include "render/gl.h"
#include "render/lines.h"

#include <span>

namespace diatom::render {

/// Triangles of one vertex layout, uploaded together.
struct Batch
{
   VertexArray array;
   Buffer buffer;
   GLsizei vertices = 0;
};

class OverlayPass
{
public:
   Status start();
   /// World points are stored relative to `anchor`.
   void setLines(Batch &batch, std::span<const Line> lines, const Vec3 &anchor);
   void setPolygons(Batch &batch, std::span<const Polygon> polygons, const Vec3 &anchor);
   void setBoxes(Batch &batch, std::span<const SolidBox> boxes, const Vec3 &anchor);

   void drawLines(const Batch &batch, const Eigen::Matrix4f &transform, float width, float height,
                  float opacity);
   void drawPolygons(const Batch &batch, const Eigen::Matrix4f &transform, float opacity);
   void drawBoxes(const Batch &batch, const Eigen::Matrix4f &transform, float lineWidth);
   /// Line widths and screen positions are logical pixels; this many device pixels each.
   void setScale(float scale) { m_scale = scale; }

private:
   Program m_lineProgram, m_fillProgram, m_boxProgram;
   float m_scale = 1;
};

} // namespace diatom::render
