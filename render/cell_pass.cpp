#include "render/cell_pass.h"

#include "render/shaders.h"

namespace diatom::render {

namespace {

/// Whether any of the box may be in front of all six planes of the view.
bool inView(const Eigen::AlignedBox3f &box, const Eigen::Matrix4f &transform)
{
   for (int plane = 0; plane < 6; ++plane) {
      const Eigen::RowVector4f p = transform.row(3) + (plane & 1 ? 1.0f : -1.0f) * transform.row(plane / 2);
      const Eigen::Vector3f far = (p.head<3>().transpose().array() > 0).select(box.max(), box.min());
      if (p.head<3>().dot(far) + p[3] < 0)
         return false;
   }
   return true;
}

} // namespace

Status CellPass::start()
{
   if (Status status = m_rest.build("", kCellVertex, kFaceFragment); !status)
      return status;
   return m_turned.build("#define TURNED\n", kCellVertex, kFaceFragment);
}

void CellPass::setCells(const CellMesh &mesh)
{
   m_anchor = mesh.anchor;
   m_start = mesh.start;
   m_chunks = mesh.chunks;
   m_restPositions = mesh.position;
   m_types.clear();
   std::vector<float> corners;
   for (const FaceType &type : mesh.types.types) {
      m_types.push_back(
          {type.normal, static_cast<GLint>(corners.size() / 7), static_cast<GLsizei>(type.fan.size())});
      for (const auto &corner : type.fan) {
         corners.insert(corners.end(), corner.position.data(), corner.position.data() + 3);
         corners.insert(corners.end(), corner.edge.data(), corner.edge.data() + 4);
      }
   }
   m_array.bind();
   m_corners.fill<float>(corners);
   floatAttribute(0, 3, 7 * sizeof(float), 0);
   floatAttribute(1, 4, 7 * sizeof(float), 3 * sizeof(float));
   m_faces.fill<std::uint32_t>(mesh.faces);
   glEnableVertexAttribArray(2);
   glVertexAttribDivisor(2, 1);
   glBindVertexArray(0);
   setPoses({}, {});
   const std::vector<Rgba> grey(mesh.cells.size(), Rgba{170, 170, 170, 255});
   setColors(grey);
}

void CellPass::setColors(std::span<const Rgba> bySlot) { m_colors.fill(bySlot, GL_RGBA8); }

void CellPass::setPoses(std::span<const float> position, std::span<const float> turn)
{
   m_moving = !position.empty();
   m_positions.fill(m_moving ? position : std::span<const float>(m_restPositions), GL_RGBA32F);
   if (m_moving)
      m_turns.fill(turn, GL_RGBA32F);
}

void CellPass::draw(const Camera &camera, const Eigen::Matrix4f &transform, float lineWidth)
{
   m_drawn = 0;
   if (m_chunks.empty())
      return;
   const Program &program = m_moving ? m_turned : m_rest;
   program.use();
   program.set("transform", transform);
   program.set("lineWidth", lineWidth);
   program.set("positions", 0);
   program.set("colors", 1);
   m_positions.bind(0);
   m_colors.bind(1);
   if (m_moving) {
      program.set("turns", 2);
      m_turns.bind(2);
   }
   std::vector<bool> visible(m_chunks.size(), true);
   for (std::size_t c = 0; c < m_chunks.size() && !m_moving; ++c)
      visible[c] = inView(m_chunks[c], transform);
   m_array.bind();
   glEnable(GL_CULL_FACE);
   for (std::size_t t = 0; t < m_types.size(); ++t) {
      program.set("normal", m_types[t].normal);
      drawRuns(m_types[t], t, visible, camera);
   }
   glDisable(GL_CULL_FACE);
   glBindVertexArray(0);
}

void CellPass::drawRuns(const Type &type, std::size_t number, const std::vector<bool> &inView,
                        const Camera &camera)
{
   const Eigen::Vector3f back = camera.backward().cast<float>();
   const Eigen::Vector3f eye = (camera.eye() - m_anchor).cast<float>();
   const auto facesEye = [&](const Eigen::AlignedBox3f &chunk) {
      if (m_moving)
         return true;
      if (camera.orthographic())
         return type.normal.dot(back) > 0;
      const Eigen::Vector3f nearest = (type.normal.array() > 0).select(chunk.min(), chunk.max());
      return type.normal.dot(eye - nearest) > 0;
   };
   glBindBuffer(GL_ARRAY_BUFFER, m_faces.name());
   std::uint32_t from = 0, to = 0; // pending run
   const auto flush = [&] {
      if (from == to)
         return;
      glVertexAttribIPointer(2, 1, GL_UNSIGNED_INT, sizeof(std::uint32_t),
                             bufferOffset(sizeof(std::uint32_t) * std::size_t{from}));
      glDrawArraysInstanced(GL_TRIANGLE_FAN, type.first, type.corners, static_cast<GLsizei>(to - from));
      m_drawn += to - from;
   };
   for (std::size_t c = 0; c < m_chunks.size(); ++c) {
      const std::size_t run = number * m_chunks.size() + c;
      if (m_start[run] == m_start[run + 1] || !inView[c] || !facesEye(m_chunks[c]))
         continue;
      if (to != m_start[run]) {
         flush();
         from = m_start[run];
      }
      to = m_start[run + 1];
   }
   flush();
}

} // namespace diatom::render
