// Draws the triangles of parts or struts. For the .cpp files of render/ only.
#pragma once

#include "render/gl.h"
#include "render/surface.h"

namespace diatom::render {

class SurfacePass
{
public:
   Status start();
   void setSurface(const Surface &surface);
   const Vec3 &anchor() const { return m_anchor; }
   /// `transform` takes world metres about this pass's anchor to clip space.
   void draw(const Eigen::Matrix4f &transform, float lineWidth);
   /// Both sides of each triangle, mixed with what is behind.
   void drawTranslucent(const Eigen::Matrix4f &transform, float opacity);

private:
   void drawTriangles(const Eigen::Matrix4f &transform, float lineWidth);

   Program m_program;
   VertexArray m_array;
   Buffer m_corners;
   GLsizei m_count = 0;
   Vec3 m_anchor = Vec3::Zero();
};

} // namespace diatom::render
