// DNA bricks drawn as blocks: a run of cells is one block with a plug below and a socket on top of each cell.
// Measures: DMDesign's block, lattice units. Its plug is longer than the socket is deep; ours ends within it.
#include <diatom/part_runs.hpp>
#include <diatom/part_shapes.hpp>

using namespace diatom::sdk;

namespace {

constexpr double kWidth = 0.95, kHeight = 1.03, kRadius = 0.3, kDepth = 0.8;
constexpr int kLongest = 10'000;

/// Frame: origin in the first cell's centre, run along +x.
PartMesh block(const MeshRequest &request)
{
   if (request.length > kLongest)
      throw Failure(DIATOM_LIMIT,
                    "a block of " + std::to_string(request.length) + " cells is too long to mesh");
   const int round = request.detail == 0 ? 12 : 64;
   std::vector<Prism> prisms;
   for (int cell = 0; cell < request.length; ++cell) {
      const double left = cell - (cell == 0 ? kWidth / 2 : 0.5);
      const double right = cell + (cell + 1 == request.length ? kWidth / 2 : 0.5);
      const auto plug = circle({double(cell), 0}, kRadius, round);
      addSurround(prisms, {left, -kWidth / 2}, {right, kWidth / 2}, plug, 6);
      prisms.push_back({plug, 3});
   }
   PartMesh mesh;
   Prisms(mesh, request.pitch)
       .add({-kHeight / 2 - kDepth, -kHeight / 2, kHeight / 2 - kDepth, kHeight / 2}, prisms);
   return mesh;
}

void decompose(const Call &call, const diatom_cells &cells, PartList &parts)
{
   needHeight(cells, 1.08, "DNA bricks");
   onePartPerRun(call, cells, parts);
}

PartSet gikDnaBlocks(const Values &)
{
   PartSet set;
   set.kinds = {{"block", "DNA block", 1}};
   set.lattices = {"org.diatom_cad.lattice.gik"};
   set.details = 2;
   set.mesh = block;
   set.decompose = decompose;
   return set;
}

} // namespace

DIATOM_PARTS(gikDnaBlocks)
