#include "render/surface_pass.h"

#include "render/shaders.h"

#include <cstddef>
#include <span>

namespace diatom::render {

Status SurfacePass::start() { return m_program.build("", kSurfaceVertex, kFaceFragment); }

void SurfacePass::setSurface(const Surface &surface)
{
   m_anchor = surface.anchor;
   m_count = static_cast<GLsizei>(surface.corners.size());
   m_array.bind();
   m_corners.fill(std::span<const Surface::Corner>(surface.corners));
   constexpr GLsizei stride = sizeof(Surface::Corner);
   floatAttribute(0, 3, stride, offsetof(Surface::Corner, position));
   floatAttribute(1, 3, stride, offsetof(Surface::Corner, edge));
   floatAttribute(2, 3, stride, offsetof(Surface::Corner, color));
   glBindVertexArray(0);
}

void SurfacePass::draw(const Eigen::Matrix4f &transform, float lineWidth)
{
   glEnable(GL_CULL_FACE);
   drawTriangles(transform, lineWidth);
   glDisable(GL_CULL_FACE);
}

void SurfacePass::drawTranslucent(const Eigen::Matrix4f &transform, float opacity)
{
   glEnable(GL_BLEND);
   glBlendColor(0, 0, 0, opacity);
   glBlendFuncSeparate(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA, GL_ZERO, GL_ONE);
   glDepthMask(GL_FALSE);
   drawTriangles(transform, 0);
}

void SurfacePass::drawTriangles(const Eigen::Matrix4f &transform, float lineWidth)
{
   if (m_count == 0)
      return;
   m_program.use();
   m_program.set("transform", transform);
   m_program.set("lineWidth", lineWidth);
   m_array.bind();
   glDrawArrays(GL_TRIANGLES, 0, m_count);
}

} // namespace diatom::render
