// What the viewport shows of a design: meshes from the hierarchy, colours, and the poses of a running simulation.
#pragma once

#include "gui/simulation_player.h"
#include "render/cell_mesh.h"
#include "render/composite_boxes.h"
#include "render/renderer.h"

#include <memory>
#include <vector>

namespace diatom::gui {

class SceneView
{
public:
   /// Above this many logical cells composites are drawn as boxes, whatever the view.
   static constexpr std::uint64_t kCellBudget = 2'000'000;

   void setDesign(std::shared_ptr<const Hierarchy> hierarchy, bool composites, bool grid);
   void setFrame(std::shared_ptr<const PlayedFrame> frame, bool byDisplacement);
   /// Hands over what changed since the last call; needs the renderer's context.
   void upload(render::Renderer &renderer);

   const render::Bounds &bounds() const { return m_bounds; }
   /// Of content and base plane: what must not be clipped.
   render::Bounds reach() const;
   /// Centre of a cell as drawn now.
   Vec3 position(Index cell) const;
   std::uint64_t faces() const { return m_mesh.exposedFaces(); }
   bool boxed() const { return m_boxed; }

private:
   void poses(render::Renderer &renderer);
   void colors(render::Renderer &renderer);

   std::shared_ptr<const Hierarchy> m_hierarchy;
   render::CellMesh m_mesh;
   std::vector<render::SolidBox> m_boxes;
   std::vector<render::Line> m_grid;
   render::Bounds m_bounds;
   std::shared_ptr<const PlayedFrame> m_frame;
   std::vector<std::int64_t> m_sceneCell; // by slot, of the frame's scene
   bool m_byDisplacement = false, m_boxed = false;
   bool m_newMesh = false, m_newFrame = false;
};

} // namespace diatom::gui
