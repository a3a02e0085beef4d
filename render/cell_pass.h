// Draws the exposed faces of cells: one instance per face, one run per face type and chunk, runs out of view
// or turned away left out. For the .cpp files of render/ only.
#pragma once

#include "render/camera.h"
#include "render/cell_mesh.h"
#include "render/color_map.h"
#include "render/gl.h"

#include <span>
#include <vector>

namespace diatom::render {

class CellPass
{
public:
   Status start();
   void setCells(const CellMesh &mesh);
   void setColors(std::span<const Rgba> bySlot);
   void setPoses(std::span<const float> position, std::span<const float> turn);
   /// `transform` takes world metres about the anchor to clip space.
   void draw(const Camera &camera, const Eigen::Matrix4f &transform, float lineWidth);
   const Vec3 &anchor() const { return m_anchor; }
   std::uint64_t facesDrawn() const { return m_drawn; }

private:
   struct Type
   {
      Eigen::Vector3f normal;
      GLint first = 0;
      GLsizei corners = 0;
   };
   void drawRuns(const Type &type, std::size_t number, const std::vector<bool> &inView, const Camera &camera);

   Program m_rest, m_turned;
   VertexArray m_array;
   Buffer m_corners, m_faces;
   TextureBuffer m_positions, m_turns, m_colors;
   std::vector<Type> m_types;
   std::vector<std::uint32_t> m_start;
   std::vector<Eigen::AlignedBox3f> m_chunks;
   std::vector<float> m_restPositions;
   Vec3 m_anchor = Vec3::Zero();
   bool m_moving = false;
   std::uint64_t m_drawn = 0;
};

} // namespace diatom::render
