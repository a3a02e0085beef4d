// Octahedra joined by corners as flat crosses on the corners where two cells meet: a cross has two struts in
// either cell, all in one plane. Crosses on x corners lie in the x-y plane, those on y corners in y-z, those
// on z corners in z-x: so each of a cell's twelve edges is a strut of exactly one of them. Where a corner is
// free, or the other cell is of another material, a half cross with two struts stands in.
#include <diatom/part_shapes.hpp>

#include <algorithm>

#include <array>
#include <unordered_map>

using namespace diatom::sdk;

namespace {

constexpr double kThickness = 0.06; // lattice units (edge of the octahedron = 1)

/// Frame: the corner is the origin, struts go towards +-y; the half cross has its cell at -x.
PartMesh cross(const MeshRequest &request)
{
   const double reach = std::sqrt(0.5), half = kThickness / 2, tip = kThickness, inner = reach - 0.1;
   // A strut of the cell at -x, from the corner towards +y: it ends at the side of the cross on the y corner,
   // and stays within the cell.
   const std::vector<Xy> strut{
       {inner - reach, 0},          {0, 0}, {0, tip}, {tip - reach, reach}, {half - reach, reach},
       {half - reach, inner - half}};
   std::vector<Prism> prisms;
   for (const double x : {1, -1})
      for (const double y : {1, -1}) {
         if (x < 0 && request.type == 1)
            continue;
         Prism prism;
         for (const Xy &at : strut)
            prism.outline.push_back({x * at[0], y * at[1]});
         if (x * y < 0)
            std::reverse(prism.outline.begin() + 1, prism.outline.end());
         prisms.push_back(std::move(prism));
      }
   PartMesh mesh;
   Prisms(mesh, request.pitch).add({-half, half}, prisms);
   return mesh;
}

using Index = std::array<std::int32_t, 3>;

struct IndexHash
{
   std::size_t operator()(const Index &i) const
   {
      std::uint64_t h = 0;
      for (const std::int32_t v : i)
         h = (h ^ static_cast<std::uint32_t>(v)) * 0x9e3779b97f4a7c15u;
      return static_cast<std::size_t>(h ^ h >> 32);
   }
};

/// Edges are those of the lattice, whatever turn a cell has: an octahedron looks alike after each.
void decompose(const Call &call, const diatom_cells &cells, PartList &parts)
{
   std::unordered_map<Index, std::int64_t, IndexHash> at;
   at.reserve(static_cast<std::size_t>(cells.count));
   const auto indexOf = [&](std::int64_t i) {
      return Index{cells.index[3 * i], cells.index[3 * i + 1], cells.index[3 * i + 2]};
   };
   for (std::int64_t i = 0; i < cells.count; ++i)
      at.emplace(indexOf(i), i);
   // x to y to z to x; then the same after a half turn about the axis that each plane stands on.
   const Wxyz axis[3] = {{1, 0, 0, 0}, {0.5, 0.5, 0.5, 0.5}, {0.5, -0.5, -0.5, -0.5}};
   const Wxyz back{0, 0, 0, 1};
   for (std::int64_t i = 0; i < cells.count; ++i) {
      pollEvery(call, i);
      for (std::size_t a = 0; a < 3; ++a)
         for (const int side : {1, -1}) {
            Index beyond = indexOf(i);
            beyond[a] += side;
            const auto other = at.find(beyond);
            const bool meets = other != at.end() && cells.material[other->second] == cells.material[i];
            if (meets && side < 0)
               continue; // the other cell has it
            Xyz corner = cellPosition(cells, i);
            corner[a] += side * std::sqrt(0.5) * cells.pitch;
            const Wxyz turn = side > 0 ? axis[a] : turned(axis[a], back);
            if (meets)
               parts.add(0, 1, cells.material[i], corner, turn, {i, other->second});
            else
               parts.add(1, 1, cells.material[i], corner, turn, {i});
         }
   }
}

PartSet octahedronCrosses(const Values &)
{
   PartSet set;
   set.kinds = {{"cross", "Cross", 6}, {"half_cross", "Half cross", 6}}; // a cell has six corners
   set.lattices = {"org.diatom_cad.lattice.octahedron_vertex"};
   set.mesh = cross;
   set.decompose = decompose;
   return set;
}

} // namespace

DIATOM_PARTS(octahedronCrosses)
