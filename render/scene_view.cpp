#include "render/scene_view.h"

#include "render/design_overlay.h"

#include <algorithm>

namespace diatom::render {

namespace {

std::int64_t numberOf(const std::vector<Index> &sorted, Index i)
{
   const auto found = std::lower_bound(sorted.begin(), sorted.end(), i);
   return found != sorted.end() && *found == i ? found - sorted.begin() : -1;
}

} // namespace

void SceneView::setDesign(std::shared_ptr<const Hierarchy> hierarchy, bool composites, bool grid)
{
   m_hierarchy = std::move(hierarchy);
   m_own.reset();
   m_mesh = {};
   m_whole = false;
   m_boxes.clear();
   m_grid.clear();
   m_bounds.setEmpty();
   m_frame.reset();
   m_surface.reset();
   m_newMesh = true;
   m_boxed = false;
   if (!m_hierarchy)
      return;
   const Lattice &lattice = m_hierarchy->lattice();
   const Model &model = m_hierarchy->model();
   if (grid)
      m_grid = baseGrid(lattice, m_hierarchy->bounds(), {70, 85, 100, 110});
   const bool tooMany = m_hierarchy->cells() > kCellBudget;
   m_boxed = (composites || tooMany) && model.root.instances.count() > 0;
   m_own = m_hierarchy;
   if (m_boxed)
      m_own = std::make_shared<const Hierarchy>(std::shared_ptr<const Lattice>(m_hierarchy, &lattice),
                                                ownCells(model));
   if (m_own->cells() <= kCellBudget) {
      buildMesh(Covered::dropped);
   } else {
      m_boxed = true;
      m_boxes = blockBoxes(lattice, model);
      m_own.reset();
   }
   if (m_boxed) {
      const auto boxes = compositeBoxes(lattice, model);
      m_boxes.insert(m_boxes.end(), boxes.begin(), boxes.end());
   }
   m_bounds = worldBounds(lattice, m_hierarchy->bounds());
}

void SceneView::buildMesh(Covered covered)
{
   const Job job;
   m_whole = covered == Covered::keptOnSurface;
   m_newMesh = true;
   m_sceneCell.clear();
   if (auto mesh = buildCellMesh(*m_own, job, kCellBudget, covered))
      m_mesh = std::move(*mesh);
}

void SceneView::setFrame(std::shared_ptr<const Moment> frame, bool coloured)
{
   const bool whole = frame && m_mesh.cells.size() <= kWholeCellBudget;
   if (m_own && whole != m_whole)
      buildMesh(whole ? Covered::keptOnSurface : Covered::dropped);
   if (frame && (m_sceneCell.empty() || !m_frame || m_frame->indices != frame->indices)) {
      m_sceneCell.clear();
      for (const Index i : m_mesh.cells)
         m_sceneCell.push_back(numberOf(*frame->indices, i));
   }
   m_frame = std::move(frame);
   m_coloured = coloured;
   m_newFrame = true;
}

void SceneView::setSurface(std::shared_ptr<const Surface> surface)
{
   if (surface == m_surface)
      return;
   m_surface = std::move(surface);
   m_newMesh = true;
   if (m_surface)
      m_bounds.extend(m_surface->bounds);
}

void SceneView::setReferences(std::shared_ptr<const Surface> references)
{
   m_references = std::move(references);
   m_newReferences = true;
}

Bounds SceneView::bounds() const
{
   Bounds bounds = m_bounds;
   if (m_references)
      bounds.extend(m_references->bounds);
   return bounds;
}

void SceneView::upload(Renderer &renderer)
{
   if (m_newMesh) {
      CellMesh none;
      none.anchor = m_mesh.anchor; // what lies over the scene is about it
      renderer.setCells(m_surface ? none : m_mesh);
      renderer.setBoxes(m_surface ? std::span<const SolidBox>() : m_boxes);
      renderer.setSurface(m_surface ? *m_surface : Surface());
      renderer.setGrid(m_grid);
   }
   if (!m_surface && (m_newMesh || m_newFrame)) {
      poses(renderer);
      colors(renderer);
   }
   if (m_newReferences)
      renderer.setReferences(m_references ? *m_references : Surface());
   m_newMesh = m_newFrame = m_newReferences = false;
}

void SceneView::poses(Renderer &renderer)
{
   if (!m_frame) {
      renderer.setPoses({}, {});
      return;
   }
   std::vector<float> position = m_mesh.position, turn(position.size(), 0.0f);
   for (std::size_t slot = 0; slot < m_mesh.cells.size(); ++slot) {
      turn[4 * slot] = 1;
      const std::int64_t cell = m_sceneCell[slot];
      if (cell < 0)
         continue;
      const auto c = static_cast<std::size_t>(cell);
      for (std::size_t i = 0; i < 3; ++i)
         position[4 * slot + i] =
             static_cast<float>(m_frame->frame.position[3 * c + i] - m_mesh.anchor[long(i)]);
      for (std::size_t i = 0; i < 4; ++i)
         turn[4 * slot + i] = static_cast<float>(m_frame->frame.rotation[4 * c + i]);
   }
   renderer.setPoses(position, turn);
}

void SceneView::colors(Renderer &renderer)
{
   if (!m_hierarchy)
      return;
   const Model &model = m_hierarchy->model();
   std::vector<Rgba> colors;
   colors.reserve(m_mesh.cells.size());
   for (std::size_t slot = 0; slot < m_mesh.cells.size(); ++slot) {
      const std::int64_t cell = m_frame && m_coloured ? m_sceneCell[slot] : -1;
      if (cell >= 0) {
         const double value = m_frame->values[static_cast<std::size_t>(cell)];
         const double range = m_frame->highest - m_frame->lowest;
         colors.push_back(fieldColor(range > 0 ? (value - m_frame->lowest) / range : 0));
         continue;
      }
      const auto &rgb = model.material(m_mesh.material[slot]).color;
      colors.push_back({rgb[0], rgb[1], rgb[2], 255});
   }
   renderer.setColors(colors);
}

Bounds SceneView::reach() const
{
   Bounds bounds = this->bounds();
   for (const Line &line : m_grid) {
      bounds.extend(line.a);
      bounds.extend(line.b);
   }
   if (!m_bounds.isEmpty()) { // room for what a simulation moves
      const Vec3 margin = m_bounds.diagonal();
      bounds.extend(m_bounds.min() - margin);
      bounds.extend(m_bounds.max() + margin);
   }
   return bounds;
}

Vec3 SceneView::position(Index cell) const
{
   if (m_frame)
      if (const std::int64_t c = numberOf(*m_frame->indices, cell); c >= 0)
         return Eigen::Map<const Vec3>(m_frame->frame.position.data() + 3 * c);
   return m_hierarchy ? m_hierarchy->lattice().position(cell) : Vec3::Zero();
}

} // namespace diatom::render
