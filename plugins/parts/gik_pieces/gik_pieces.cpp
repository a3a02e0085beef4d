// GIK micro-LEGO cell by cell: the pieces that a slotted plate is drawn from. Ends stop short of the cell
// wall, inner pieces run from wall to wall; each has a slot from above and one from below at the cell's
// centre, into which the plates of the next layers go. Measures: DMDesign's, mm at its pitch of 1.27 mm.
#include <diatom/part_runs.hpp>
#include <diatom/part_shapes.hpp>

using namespace diatom::sdk;

namespace {

constexpr double kPitch = 1.27, kThickness = 0.254, kHeight = 3.175;
constexpr double kInset = 0.0635, kSlotDepth = 0.7744;

enum Type : std::int32_t { inner, end, single };

/// Frame: origin in the cell's centre, plate in the x-z plane, an end's short side towards -x.
PartMesh piece(const MeshRequest &request)
{
   const double y = kThickness / 2, half = kThickness / 2;
   const double left = -kPitch / 2 + (request.type == inner ? 0 : kInset);
   const double right = kPitch / 2 - (request.type == single ? kInset : 0);
   std::vector<Prism> columns;
   const auto column = [&](double from, double to, std::uint32_t solid) {
      columns.push_back({{{from, -y}, {to, -y}, {to, y}, {from, y}}, solid});
   };
   if (request.detail == 0) {
      column(left, right, 1);
   } else {
      column(left, -half, 7);
      column(-half, half, 2); // between the slots
      column(half, right, 7);
   }
   PartMesh mesh;
   const double top = kHeight / 2, slot = top - kSlotDepth;
   const std::vector<double> whole{-top, top}, slotted{-top, -slot, slot, top};
   Prisms(mesh, request.pitch / kPitch).add(request.detail == 0 ? whole : slotted, columns);
   return mesh;
}

void pieces(const Call &call, const diatom_cells &cells, PartList &parts)
{
   constexpr Wxyz kBack{0, 0, 0, 1}; // half a turn about z
   for (const auto &run : runsOf(call, cells))
      for (const std::int64_t cell : run) {
         const bool first = cell == run.front(), last = cell == run.back();
         const Wxyz along = alongRun(cells.site[cell]);
         parts.add(first && last   ? single
                   : first || last ? end
                                   : inner,
                   1, cells.material[cell], cellPosition(cells, cell),
                   last && !first ? turned(along, kBack) : along, {cell});
      }
}

PartSet gikPieces(const Values &)
{
   PartSet set;
   set.kinds = {{"inner", "Inner piece", 1}, {"end", "End piece", 1}, {"single", "Piece of one cell", 1}};
   set.lattices = {"org.diatom_cad.lattice.gik"};
   set.details = 2;
   set.mesh = piece;
   set.decompose = pieces;
   return set;
}

} // namespace

DIATOM_PARTS(gikPieces)
