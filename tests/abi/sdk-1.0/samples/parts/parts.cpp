// Every cell is one block, a little smaller than the cell.
#include <diatom/parts.hpp>

using namespace diatom::sdk;

static PartSet blocks(const Values &values)
{
   const double shrink = values.number("shrink");
   PartSet set;
   set.kinds = {{"block", "Block", 1}};
   set.lattices = {"*"};
   set.mesh = [shrink](const MeshRequest &request) {
      const double h = request.pitch * (1 - shrink) / 2;
      PartMesh mesh;
      for (int corner = 0; corner < 8; ++corner)
         mesh.vertex(corner & 1 ? h : -h, corner & 2 ? h : -h, corner & 4 ? h : -h);
      mesh.quad(0, 4, 6, 2);
      mesh.quad(1, 3, 7, 5);
      mesh.quad(0, 1, 5, 4);
      mesh.quad(2, 6, 7, 3);
      mesh.quad(0, 2, 3, 1);
      mesh.quad(4, 5, 7, 6);
      return mesh;
   };
   set.decompose = [](const Call &call, const diatom_cells &cells, PartList &parts) {
#ifdef DIATOM_GROWN // built with headers of a later minor: a member that today's host does not have
      if (DIATOM_HAS(diatom_cells, &cells, grown))
         throw Failure(DIATOM_INTERNAL, "the host says that it has what it cannot have");
#endif
      for (std::int64_t i = 0; i < cells.count; ++i) {
         pollEvery(call, i);
         const double *at = cells.position + 3 * i;
         parts.add(0, 1, cells.material[i], {at[0], at[1], at[2]}, {1, 0, 0, 0}, {i});
      }
   };
   return set;
}
DIATOM_PARTS(blocks)
