#include "render/composite_boxes.h"

#include "render/cell_mesh.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

namespace diatom::render {

namespace {

SolidBox boxOf(const Bounds &bounds, const Quat &turn, const Vec3 &origin, Rgba color)
{
   SolidBox box;
   box.centre = origin + turn * bounds.center();
   box.axes = turn.toRotationMatrix() * (bounds.diagonal() / 2).asDiagonal();
   box.color = color;
   return box;
}

Rgba opaque(const std::array<std::uint8_t, 3> &color) { return {color[0], color[1], color[2], 255}; }

/// Bounds of definitions about their own origin, in their own axes.
class DefinitionBounds
{
public:
   DefinitionBounds(const Lattice &lattice, const Model &model) : m_lattice(lattice), m_model(model) {}

   const Bounds &of(DefinitionId id)
   {
      const auto [entry, fresh] = m_known.try_emplace(id);
      const Definition *definition = m_model.definition(id);
      if (!fresh || !definition)
         return entry->second;
      Bounds bounds = worldBounds(m_lattice, definition->body.cells.bounds());
      const Vec3 zero = m_lattice.position({});
      if (!bounds.isEmpty())
         bounds.translate(-zero);
      definition->body.instances.visit([&](const Placement &p) {
         const Bounds inner = of(p.definition);
         for (int i = 0; i < 8 && !inner.isEmpty(); ++i)
            bounds.extend(m_lattice.position(p.origin) - zero +
                          turn(p) * inner.corner(static_cast<Bounds::CornerType>(i)));
         return true;
      });
      return m_known[id] = bounds;
   }

   Quat turn(const Placement &p) const { return m_lattice.rotations()[p.rotation]; }

private:
   const Lattice &m_lattice;
   const Model &m_model;
   std::map<DefinitionId, Bounds> m_known;
};

} // namespace

std::vector<SolidBox> compositeBoxes(const Lattice &lattice, const Model &model, std::size_t limit)
{
   std::vector<SolidBox> boxes;
   DefinitionBounds bounds(lattice, model);
   model.root.instances.visit([&](const Placement &p) {
      const Bounds &own = bounds.of(p.definition);
      if (!own.isEmpty())
         boxes.push_back(boxOf(own, bounds.turn(p), lattice.position(p.origin),
                               opaque(model.definition(p.definition)->color)));
      return boxes.size() < limit;
   });
   return boxes;
}

std::vector<SolidBox> blockBoxes(const Lattice &lattice, const Model &model, std::size_t limit)
{
   struct Merged
   {
      Box box;
      std::map<MaterialIndex, double> share;
   };
   // Blocks that lie in one cube of 2^shift cells are merged; the cube grows until few enough are left.
   std::map<std::tuple<int, int, int>, Merged> merged;
   for (int shift = 4; shift < 31; ++shift) {
      merged.clear();
      model.root.cells.visitBlocks(model.root.cells.bounds(), [&](const Box &box, Cell cell) {
         Merged &m = merged[{box.min.x >> shift, box.min.y >> shift, box.min.z >> shift}];
         m.box.extend(box);
         m.share[cell.material] += box.volume();
         return merged.size() <= limit;
      });
      if (merged.size() <= limit)
         break;
   }
   std::vector<SolidBox> boxes;
   for (const auto &[key, m] : merged) {
      const auto most = std::max_element(m.share.begin(), m.share.end(),
                                         [](const auto &a, const auto &b) { return a.second < b.second; });
      boxes.push_back(boxOf(worldBounds(lattice, m.box), Quat::Identity(), Vec3::Zero(),
                            opaque(model.material(most->first).color)));
   }
   return boxes;
}

Model ownCells(const Model &model)
{
   Model own = model;
   own.root.instances = {};
   return own;
}

} // namespace diatom::render
