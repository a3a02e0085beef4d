#include "model/cell_model.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace bonds {

using diatom::sdk::Failure;

CellModel cellModelOf(const diatom::sdk::SceneView &scene, std::int32_t material)
{
   const double value = scene.property(material, "cell_model");
   if (std::isnan(value) || value == 0)
      return CellModel::bond;
   if (value == 1)
      return CellModel::block;
   if (value != 2)
      throw Failure(DIATOM_BAD_INPUT, "the cell model of material " + std::to_string(material) +
                                          " must be 0 (bond), 1 (block) or 2 (solid)");
   return scene.hasEffect("solid") ? CellModel::solid : CellModel::bond;
}

bool hasOwnConstants(const diatom::sdk::SceneView &scene, std::int32_t material)
{
   static constexpr const char *kNames[] = {"axial_x",   "axial_y",   "axial_z",   "shear_xy",  "shear_xz",
                                            "shear_yx",  "shear_yz",  "shear_zx",  "shear_zy",  "bending_x",
                                            "bending_y", "bending_z", "torsion_x", "torsion_y", "torsion_z"};
   return std::any_of(std::begin(kNames), std::end(kNames),
                      [&](const char *name) { return !std::isnan(scene.property(material, name)); });
}

Neighbours::Neighbours(std::int64_t cells) : m_next(static_cast<std::size_t>(cells))
{
   for (auto &next : m_next)
      next.fill(-1);
}

void Neighbours::join(std::int32_t a, std::int32_t b, int axis)
{
   m_next[a][2 * axis + 1] = b;
   m_next[b][2 * axis] = a;
}

} // namespace bonds
