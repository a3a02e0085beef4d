#include "solid/couplings.h"

#include "model/cell_model.h"
#include "solid/cell_coupling.h"

#include <optional>
#include <string>

namespace bonds {

using sdk::Failure;

namespace {

/// Edges of a cell's box along the world axes; exact for quarter turns.
std::array<double, 3> worldExtent(const sdk::SceneView &scene, std::int64_t cell)
{
   const double *e = scene.extent(cell), *q = scene.orientation(cell);
   if (e[0] == e[1] && e[1] == e[2]) // an isotropic cube is the same however it is turned
      return {e[0], e[1], e[2]};
   const Mat3 own = matrix({q[0], q[1], q[2], q[3]});
   const auto along = [&](Vec3 row) {
      return std::abs(row.x) * e[0] + std::abs(row.y) * e[1] + std::abs(row.z) * e[2];
   };
   return {along(own.r0), along(own.r1), along(own.r2)};
}

/// Poisson's ratio belongs to a law of E and nu in cells that fill the space between their neighbours.
void check(const sdk::SceneView &scene, const Assembly &assembly, std::int64_t cell)
{
   const std::array<double, 3> extent = worldExtent(scene, cell);
   for (std::int64_t s = assembly.first[cell]; s < assembly.first[cell + 1]; ++s) {
      const std::int64_t bond = assembly.bondsOf[s] / 2;
      const int axis = assembly.axisOf(bond);
      if (axis < 3 && std::abs(assembly.lengthOf(bond) - extent[axis]) <= 1e-6 * extent[axis])
         continue;
      throw Failure(DIATOM_UNSUPPORTED,
                    "the cell " + scene.name(cell) +
                        " does not fill a lattice of boxes, which solids and Poisson's ratio need: give its "
                        "material the cell model \"bond\" and switch the effect \"poisson\" off");
   }
}

/// Of a material whose cells couple.
struct CellLaw
{
   double youngsModulus = 0, poissonRatio = 0, dampingRatio = 0;
};

/// Nothing where the material's cells do not couple.
std::optional<CellLaw> lawOf(const sdk::SceneView &scene, std::int32_t material)
{
   const bool solid = cellModelOf(scene, material) == CellModel::solid;
   const double asked = scene.property(material, "poisson_coupling");
   if (!solid && (!scene.hasEffect("poisson") || asked == 0))
      return {};
   const bool own = hasOwnConstants(scene, material);
   if (solid && own)
      throw Failure(DIATOM_BAD_INPUT,
                    "material " + std::to_string(material) +
                        " is a solid and must not have bond constants of its own: give it a "
                        "Young's modulus and a Poisson ratio");
   const double nu = scene.property(material, "poisson_ratio"),
                zeta = scene.property(material, "damping_ratio");
   if (own || std::isnan(nu) || nu == 0)
      return {};
   if (!(nu < 0.5))
      throw Failure(DIATOM_BAD_INPUT, "material " + std::to_string(material) +
                                          " needs a Poisson ratio below 0.5 to be a solid or coupled");
   return CellLaw{scene.property(material, "youngs_modulus"), nu, std::isnan(zeta) ? 0 : zeta};
}

} // namespace

Couplings makeCouplings(const sdk::SceneView &scene, const Assembly &assembly)
{
   std::vector<std::optional<CellLaw>> laws;
   for (std::int32_t m = 0; m < scene.materials(); ++m)
      laws.push_back(lawOf(scene, m));
   std::vector<CoupledCell> cells;
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      const std::optional<CellLaw> &law = laws[scene.material(i)];
      if (!law)
         continue;
      check(scene, assembly, i);
      const std::array<double, 3> e = worldExtent(scene, i);
      cells.push_back({i,
                       law->youngsModulus,
                       law->poissonRatio,
                       law->dampingRatio,
                       e[0] * e[1] * e[2],
                       {e[1] * e[2], e[2] * e[0], e[0] * e[1]}});
   }
   if (!cells.empty() && assembly.law == Law::small)
      throw Failure(DIATOM_UNSUPPORTED,
                    "solids and Poisson's coupling always follow rotation: leave that effect on");
   Couplings out;
   if (!cells.empty())
      out.push_back(std::make_unique<CellCoupling>(assembly, cells));
   return out;
}

} // namespace bonds
