#include "render/overlay_pass.h"

#include "render/shaders.h"

#include <vector>

namespace diatom::render {

namespace {

void append(std::vector<float> &out, const Vec3 &v)
{
   for (int i = 0; i < 3; ++i)
      out.push_back(static_cast<float>(v[i]));
}

void append(std::vector<float> &out, Rgba c)
{
   for (const auto byte : {c.r, c.g, c.b, c.a})
      out.push_back(static_cast<float>(byte) / 255.0f);
}

} // namespace

Status OverlayPass::start()
{
   if (Status status = m_lineProgram.build("", kLineVertex, kLineFragment); !status)
      return status;
   if (Status status = m_fillProgram.build("", kFillVertex, kFillFragment); !status)
      return status;
   return m_boxProgram.build("", kBoxVertex, kFaceFragment);
}

void OverlayPass::setLines(Batch &batch, std::span<const Line> lines, const Vec3 &anchor)
{
   constexpr float corners[6][2] = {{0, -1}, {1, -1}, {1, 1}, {0, -1}, {1, 1}, {0, 1}};
   std::vector<float> data;
   data.reserve(lines.size() * 6 * 13);
   for (const Line &line : lines)
      for (const auto &corner : corners) {
         append(data, line.a - anchor);
         append(data, line.b - anchor);
         data.insert(data.end(), {corner[0], corner[1], line.width * m_scale});
         append(data, line.color);
      }
   constexpr GLsizei stride = 13 * sizeof(float);
   batch.array.bind();
   batch.buffer.fill<float>(data, GL_DYNAMIC_DRAW);
   floatAttribute(0, 3, stride, 0);
   floatAttribute(1, 3, stride, 3 * sizeof(float));
   floatAttribute(2, 3, stride, 6 * sizeof(float));
   floatAttribute(3, 4, stride, 9 * sizeof(float));
   batch.vertices = static_cast<GLsizei>(data.size() / 13);
}

void OverlayPass::setPolygons(Batch &batch, std::span<const Polygon> polygons, const Vec3 &anchor)
{
   std::vector<float> data;
   for (const Polygon &polygon : polygons)
      for (std::size_t i = 2; i < polygon.corners.size(); ++i)
         for (const std::size_t corner : {std::size_t{0}, i - 1, i}) {
            append(data, polygon.corners[corner] - anchor);
            append(data, polygon.color);
         }
   constexpr GLsizei stride = 7 * sizeof(float);
   batch.array.bind();
   batch.buffer.fill<float>(data, GL_DYNAMIC_DRAW);
   floatAttribute(0, 3, stride, 0);
   floatAttribute(1, 4, stride, 3 * sizeof(float));
   batch.vertices = static_cast<GLsizei>(data.size() / 7);
}

void OverlayPass::setBoxes(Batch &batch, std::span<const SolidBox> boxes, const Vec3 &anchor)
{
   std::vector<float> data;
   constexpr float uv[6][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}};
   for (const SolidBox &box : boxes)
      for (int face = 0; face < 6; ++face) {
         const int axis = face / 2;
         const double sign = face & 1 ? 1 : -1;
         const Vec3 out = sign * box.axes.col(axis);
         // u, v, out right-handed, so that the face is counter-clockwise from outside.
         const Vec3 u = box.axes.col((axis + 1) % 3), v = sign * box.axes.col((axis + 2) % 3);
         for (const auto &corner : uv) {
            append(data, box.centre - anchor + out + double(corner[0]) * u + double(corner[1]) * v);
            append(data, out.normalized());
            data.insert(data.end(), {corner[0], corner[1]});
            append(data, box.color);
         }
      }
   constexpr GLsizei stride = 12 * sizeof(float);
   batch.array.bind();
   batch.buffer.fill<float>(data);
   floatAttribute(0, 3, stride, 0);
   floatAttribute(1, 3, stride, 3 * sizeof(float));
   floatAttribute(2, 2, stride, 6 * sizeof(float));
   floatAttribute(3, 4, stride, 8 * sizeof(float));
   batch.vertices = static_cast<GLsizei>(data.size() / 12);
}

void OverlayPass::drawLines(const Batch &batch, const Eigen::Matrix4f &transform, float width, float height,
                            float opacity)
{
   if (batch.vertices == 0)
      return;
   m_lineProgram.use();
   m_lineProgram.set("transform", transform);
   m_lineProgram.set("size", width, height);
   m_lineProgram.set("opacity", opacity);
   batch.array.bind();
   glDrawArrays(GL_TRIANGLES, 0, batch.vertices);
}

void OverlayPass::drawPolygons(const Batch &batch, const Eigen::Matrix4f &transform, float opacity)
{
   if (batch.vertices == 0)
      return;
   m_fillProgram.use();
   m_fillProgram.set("transform", transform);
   m_fillProgram.set("opacity", opacity);
   batch.array.bind();
   glDrawArrays(GL_TRIANGLES, 0, batch.vertices);
}

void OverlayPass::drawBoxes(const Batch &batch, const Eigen::Matrix4f &transform, float lineWidth)
{
   if (batch.vertices == 0)
      return;
   m_boxProgram.use();
   m_boxProgram.set("transform", transform);
   m_boxProgram.set("lineWidth", lineWidth);
   batch.array.bind();
   glEnable(GL_CULL_FACE);
   glDrawArrays(GL_TRIANGLES, 0, batch.vertices);
   glDisable(GL_CULL_FACE);
}

} // namespace diatom::render
