// GIK micro-LEGO: a run of L cells is one upright plate with slots at every cell centre, cut from above and
// below, into which the crossing plates of the next layers go. Measures: DMDesign's part, mm at its pitch
// of 1.27 mm. The coarse mesh has no slots: the plates that cross there fill them.
#include <diatom/part_runs.hpp>
#include <diatom/part_shapes.hpp>

using namespace diatom::sdk;

namespace {

constexpr double kPitch = 1.27;      // mm, one lattice unit
constexpr double kInset = 0.0635;    // each end stops short of the cell wall
constexpr double kThickness = 0.254; // of the plate, and width of a slot: 0.2 pitch
constexpr double kHeight = 3.175;
constexpr double kSlotDepth = 0.7744;
constexpr int kLongest = 1'000'000; // a plate of 10^6 cells has 3 * 10^7 triangles

/// Frame: origin in the first cell's centre, run along +x, plate in the x-z plane.
PartMesh plate(const MeshRequest &request)
{
   if (request.length > kLongest)
      throw Failure(DIATOM_LIMIT,
                    "a brick of " + std::to_string(request.length) + " cells is too long to mesh");
   const double y = kThickness / 2, half = kThickness / 2;
   std::vector<Prism> columns;
   const auto column = [&](double left, double right, std::uint32_t solid) {
      columns.push_back({{{left, -y}, {right, -y}, {right, y}, {left, y}}, solid});
   };
   const double left = -kPitch / 2 + kInset, right = (request.length - 0.5) * kPitch - kInset;
   if (request.detail == 0) {
      column(left, right, 1);
   } else {
      for (int cell = 0; cell < request.length; ++cell) {
         column(cell == 0 ? left : (cell - 1) * kPitch + half, cell * kPitch - half, 7);
         column(cell * kPitch - half, cell * kPitch + half, 2); // between the slots
      }
      column((request.length - 1) * kPitch + half, right, 7);
   }
   PartMesh mesh;
   const double top = kHeight / 2, slot = top - kSlotDepth;
   const std::vector<double> whole{-top, top}, slotted{-top, -slot, slot, top};
   Prisms(mesh, request.pitch / kPitch).add(request.detail == 0 ? whole : slotted, columns);
   return mesh;
}

/// A plate turned within its layer could not be slotted, so a cell's own orientation has no say.
void bricks(const Call &call, const diatom_cells &cells, PartList &parts)
{
   onePartPerRun(call, cells, parts);
}

PartSet gik(const Values &)
{
   PartSet set;
   set.kinds = {{"brick", "GIK brick", 1}};
   set.lattices = {"org.diatom_cad.lattice.gik"};
   set.details = 2;
   set.mesh = plate;
   set.decompose = bricks;
   return set;
}

} // namespace

DIATOM_PARTS(gik)
