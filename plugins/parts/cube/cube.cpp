// Cube: the part is the cell, a cube of one pitch.
#include <diatom/parts.hpp>

using namespace diatom::sdk;

namespace {

PartMesh box(const MeshRequest &request)
{
   const double h = request.pitch / 2;
   PartMesh mesh;
   for (int corner = 0; corner < 8; ++corner)
      mesh.vertex(corner & 1 ? h : -h, corner & 2 ? h : -h, corner & 4 ? h : -h);
   mesh.quad(0, 4, 6, 2); // -x
   mesh.quad(1, 3, 7, 5); // +x
   mesh.quad(0, 1, 5, 4); // -y
   mesh.quad(2, 6, 7, 3); // +y
   mesh.quad(0, 2, 3, 1); // -z
   mesh.quad(4, 5, 7, 6); // +z
   return mesh;
}

PartSet cube(const Values &)
{
   PartSet set;
   set.kinds = {{"cube", "Cube", 1}};
   set.lattices = {"org.diatom_cad.lattice.cube"};
   set.mesh = box;
   return set;
}

} // namespace

DIATOM_PARTS(cube)
