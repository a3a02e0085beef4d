#include "scene/effect_looks.h"

#include "scene/where.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

/// Whether all cells have indices that differ in one coordinate only.
bool inSingleFile(const Hierarchy &hierarchy)
{
   const Box box = hierarchy.bounds();
   return int(box.min.x == box.max.x) + int(box.min.y == box.max.y) + int(box.min.z == box.max.z) >= 2;
}

bool differsByDirection(const Material &material)
{
   const bool sideways = material.actuation.mode == Actuation::Mode::shear ||
                         material.actuation.mode == Actuation::Mode::bending;
   if (material.role == ElectricalRole::actuator && sideways)
      return true; // shears or bends towards a direction of its own
   if (!material.bonds)
      return false;
   const BondConstants &k = *material.bonds;
   const double shear = k.shear[0][1];
   for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis), b = static_cast<std::size_t>((axis + 1) % 3);
      if (k.axial[a] != k.axial[0] || k.bending[a] != k.bending[0] || k.torsion[a] != k.torsion[0] ||
          k.shear[a][b] != shear || k.shear[b][a] != shear)
         return true;
   }
   return false;
}

} // namespace

std::vector<Index> cellsWhere(const Look &look, const std::function<bool(Cell)> &wanted)
{
   std::vector<Index> cells;
   std::int64_t seen = 0;
   look.hierarchy.visit(look.hierarchy.bounds(), [&](Index i, Cell cell) {
      if (wanted(cell))
         cells.push_back(i);
      // A material that turns up later is named without a cell.
      return cells.size() < kEvidence && ++seen < kMostSearched;
   });
   std::sort(cells.begin(), cells.end());
   return cells;
}

std::string MaterialEvidence::names() const { return fmt::format("{}", fmt::join(ids, ", ")); }

MaterialEvidence materialsWhere(const Look &look, bool (*holds)(const Material &))
{
   const auto &materials = *look.hierarchy.model().materials;
   const auto counts = look.hierarchy.countByMaterial();
   std::vector<bool> found(materials.size() + 1, false);
   MaterialEvidence evidence;
   for (std::size_t m = 1; m <= materials.size() && m < counts.size(); ++m) {
      found[m] = counts[m] > 0 && holds(materials[m - 1]);
      if (found[m])
         evidence.ids.push_back(materials[m - 1].id);
   }
   if (!evidence.ids.empty())
      evidence.cells = cellsWhere(look, [&](Cell cell) { return found[cell.material]; });
   return evidence;
}

std::optional<Verdict> withoutMotion(const Look &look)
{
   if (look.analysis == Analysis::statics)
      return Verdict{false, "a static balance has no motion to slow", {}};
   if (look.analysis == Analysis::modes)
      return Verdict{false, "modes are found without what slows motion", {}};
   return std::nullopt;
}

Verdict lookDamping(const Look &look)
{
   if (auto still = withoutMotion(look))
      return *std::move(still);
   const auto damped = materialsWhere(
       look, [](const Material &material) { return material.dampingRatio > 0 || material.dampings; });
   if (damped.ids.empty())
      return {false, "no material in use has a damping ratio or dampings", {}};
   return {true, "materials with a damping ratio or dampings: " + damped.names(), damped.cells};
}

Verdict lookOrientation(const Look &look)
{
   const auto directed = materialsWhere(look, differsByDirection);
   if (directed.ids.empty())
      return {
          false, "every cell in use is the same in all directions, so that turned cells behave alike", {}};
   return {true,
           "cells differ by direction and are turned with the cell when the scene is built, at no cost in a "
           "step: " +
               directed.names(),
           directed.cells};
}

Verdict lookSolid(const Look &look)
{
   const auto solid =
       materialsWhere(look, [](const Material &material) { return material.cellModel == CellModel::solid; });
   if (solid.ids.empty())
      return {false, "no material in use is modelled as a solid", {}};
   return {true,
           "cells of these materials are solid, eight-node elements between their centres: " + solid.names(),
           solid.cells};
}

bool bondsLeaveRatioOut(const Material &material)
{
   return material.cellModel != CellModel::solid && !material.bonds && material.poissonRatio != 0;
}

Verdict lookPoisson(const Look &look)
{
   const auto asking = materialsWhere(look, [](const Material &m) { return m.poissonCoupling; });
   const auto able = materialsWhere(look, bondsLeaveRatioOut);
   if (able.ids.empty())
      return {false,
              asking.ids.empty() ? "no bonded material in use has a Poisson's ratio"
                                 : "materials ask for it that have no Poisson's ratio for bonds to "
                                   "follow: " +
                                       asking.names(),
              asking.cells};
   const auto coupled =
       materialsWhere(look, [](const Material &m) { return m.poissonCoupling && bondsLeaveRatioOut(m); });
   if (coupled.ids.empty())
      return {
          false,
          fmt::format("no material in use asks for it; sideways strain of {} does not follow axial strain",
                      able.names()),
          {}};
   if (inSingleFile(look.hierarchy))
      return {false, "cells in single file have free sides, which no bond feels", coupled.cells};
   return {true, "materials whose sideways strain follows their axial strain: " + coupled.names(),
           coupled.cells};
}

} // namespace diatom
