// What is shown of a design: meshes from its hierarchy, colours, and the poses of a simulation.
#pragma once

#include "render/cell_mesh.h"
#include "render/composite_boxes.h"
#include "render/renderer.h"
#include "render/surface.h"
#include "scene/simulation.h"

#include <memory>
#include <vector>

namespace diatom::render {

/// A moment of a simulation, or a balance. Immutable; shared between the one who steps and the one who draws.
struct Moment
{
   std::shared_ptr<const std::vector<Index>> indices; // of the scene's cells, sorted
   Frame frame;
   std::vector<double> values; // that cells are coloured by: displacement in m, or an output of the solver
   double lowest = 0, highest = 0; // of them, in the run so far
   double realTimeFactor = 0;      // simulated over wall time, lately; 0 = not known
};

class SceneView
{
public:
   /// Above this many logical cells composites are drawn as boxes, whatever the view.
   static constexpr std::uint64_t kCellBudget = 2'000'000;
   /// Up to this many drawn cells a moving scene shows covered faces too.
   static constexpr std::size_t kWholeCellBudget = 50'000;

   void setDesign(std::shared_ptr<const Hierarchy> hierarchy, bool composites, bool grid);
   void setFrame(std::shared_ptr<const Moment> frame, bool coloured);
   /// Drawn in the place of cells and boxes until another design is set; null draws those again.
   void setSurface(std::shared_ptr<const Surface> surface);
   const std::shared_ptr<const Surface> &surface() const { return m_surface; }
   /// Meshes beside the cells; they stay whatever design is set.
   void setReferences(std::shared_ptr<const Surface> references);
   /// Hands over what changed since the last call; needs the renderer's context.
   void upload(Renderer &renderer);

   /// Of cells and meshes beside them.
   Bounds bounds() const;
   /// Of content and base plane: what must not be clipped.
   Bounds reach() const;
   /// Centre of a cell as drawn now.
   Vec3 position(Index cell) const;
   std::uint64_t faces() const { return m_mesh.exposedFaces(); }
   bool boxed() const { return m_boxed; }

private:
   void buildMesh(Covered covered);
   void poses(Renderer &renderer);
   void colors(Renderer &renderer);

   std::shared_ptr<const Hierarchy> m_hierarchy;
   std::shared_ptr<const Hierarchy> m_own; // what is drawn cell by cell
   CellMesh m_mesh;
   bool m_whole = false; // the mesh has covered faces
   std::vector<SolidBox> m_boxes;
   std::vector<Line> m_grid;
   Bounds m_bounds;
   std::shared_ptr<const Surface> m_surface, m_references;
   std::shared_ptr<const Moment> m_frame;
   std::vector<std::int64_t> m_sceneCell; // by slot, of the frame's scene
   bool m_coloured = false, m_boxed = false;
   bool m_newMesh = false, m_newFrame = false, m_newReferences = false;
};

} // namespace diatom::render
