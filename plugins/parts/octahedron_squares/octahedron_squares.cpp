// Octahedra joined by corners as square frames: one round each of the three equators, so that a cell's twelve
// edges are the sides of three parts. At every corner two frames meet: one keeps the outer half of the node,
// the other the inner half, like boards halved into each other. All three are one part, turned.
#include <diatom/part_shapes.hpp>

#include <algorithm>

using namespace diatom::sdk;

namespace {

// Lattice units (edge of the octahedron = 1). A frame lies between |x| + |y| = inner and outer; its tips end
// where the next cell begins.
constexpr double kThickness = 0.06;

/// Frame: outer half of the nodes on the x axis, inner half of those on the y axis.
PartMesh square(const MeshRequest &request)
{
   const double reach = std::sqrt(0.5), outer = reach + kThickness, inner = reach - 0.1;
   const double middle = (reach + inner) / 2, tip = outer - reach, half = kThickness / 2;
   const std::vector<Xy> quarter[] = {{{middle, 0}, {reach, 0}, {reach, half}, {middle, half}},
                                      {{reach, tip},
                                       {tip, reach},
                                       {half, reach},
                                       {half, middle},
                                       {half, inner - half},
                                       {inner - half, half},
                                       {middle, half},
                                       {reach, half}},
                                      {{0, inner}, {half, inner - half}, {half, middle}, {0, middle}}};
   std::vector<Prism> prisms;
   for (const double x : {1, -1})
      for (const double y : {1, -1})
         for (const auto &piece : quarter) {
            Prism prism;
            for (const Xy &at : piece)
               prism.outline.push_back({x * at[0], y * at[1]});
            if (x * y < 0) // a mirror image goes the other way round
               std::reverse(prism.outline.begin() + 1, prism.outline.end());
            prisms.push_back(std::move(prism));
         }
   PartMesh mesh;
   Prisms(mesh, request.pitch).add({-half, half}, prisms);
   return mesh;
}

/// x to y to z to x: then each axis has one frame's outer and another's inner half. Cells meet in planes that
/// all frames end at, so a cell's own turn does no harm.
void decompose(const Call &call, const diatom_cells &cells, PartList &parts)
{
   partsPerCell(call, cells, parts, {{1, 0, 0, 0}, {0.5, 0.5, 0.5, 0.5}, {0.5, -0.5, -0.5, -0.5}});
}

PartSet octahedronSquares(const Values &)
{
   PartSet set;
   set.kinds = {{"square", "Square", 3}};
   set.lattices = {"org.diatom_cad.lattice.octahedron_vertex"};
   set.mesh = square;
   set.decompose = decompose;
   return set;
}

} // namespace

DIATOM_PARTS(octahedronSquares)
