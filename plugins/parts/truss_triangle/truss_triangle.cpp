// Truss of octahedra joined by faces: three triangular plates per cell, on the side faces that look upwards.
// A plate lies within its cell with its outer side on the face, and is cut where it meets the other two, so
// that plates touch along cell edges and at their tips and nowhere overlap.
#include <diatom/part_shapes.hpp>

#include <cmath>

using namespace diatom::sdk;

namespace {

// Lattice units. DMDesign's plate is 7.1 mm thick and is drawn at 1.2 / 84.80 of its size.
constexpr double kThickness = 7.1 * 1.2 / 84.80;

/// Frame: the cell's own; the face that looks towards +y.
PartMesh plate(const MeshRequest &request)
{
   const double h = 1 / std::sqrt(6.0), r = 1 / std::sqrt(3.0), p = request.pitch;
   // Corners of the face, counter-clockwise from outside.
   const Xyz corner[3] = {{0.5, r / 2, h}, {0, r, -h}, {-0.5, r / 2, h}};
   PartMesh mesh;
   for (const Xyz &c : corner)
      mesh.vertex(p * c[0], p * c[1], p * c[2]);
   // The inner side is a hexagon. Each of its corners lies in a neighbouring face on the line from a corner
   // of the plate to the middle of that face's opposite side (between one corner of the plate and minus
   // another), where the plates' inner planes meet.
   const double share = kThickness / h;
   for (int k = 0; k < 3; ++k)
      for (const int side : {2, 1}) { // in the face at the edge before corner k, then after it
         const Xyz &own = corner[k], &other = corner[(k + side) % 3], &third = corner[(k + 3 - side) % 3];
         Xyz at{};
         for (std::size_t a = 0; a < 3; ++a)
            at[a] = p * (own[a] + share * ((other[a] - third[a]) / 2 - own[a]));
         mesh.vertex(at[0], at[1], at[2]);
      }
   mesh.triangle(0, 1, 2);
   for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, before = 3 + 2 * k, after = before + 1;
      mesh.triangle(k, before, after);         // the tip
      mesh.quad(k, after, 3 + 2 * next, next); // along the edge
   }
   mesh.quad(8, 7, 6, 5);
   mesh.quad(8, 5, 4, 3);
   return mesh;
}

void decompose(const Call &call, const diatom_cells &cells, PartList &parts)
{
   const double s = std::sqrt(0.75);
   partsPerCell(call, cells, parts, {{1, 0, 0, 0}, {0.5, 0, 0, s}, {0.5, 0, 0, -s}});
}

PartSet trussTriangle(const Values &)
{
   PartSet set;
   set.kinds = {{"triangle", "Triangle", 3}};
   set.lattices = {"org.diatom_cad.lattice.octahedron_face"};
   set.mesh = plate;
   set.decompose = decompose;
   return set;
}

} // namespace

DIATOM_PARTS(trussTriangle)
