// LEGO bricks one cell wide: a run of L cells is one hollow brick with L studs that press into the brick
// above. Measures: DMDesign's 1 x 1 brick, mm at its pitch of 8.2 mm; longer bricks are merged from it.
#include <diatom/part_runs.hpp>
#include <diatom/part_shapes.hpp>

using namespace diatom::sdk;

namespace {

constexpr double kPitch = 8.2, kWidth = 7.79, kWall = 1.51;
constexpr double kStudRadius = 4.88 / 2,
                 kHoleRadius = 2.66 / 2; // studs are pressed into 4.77 mm between walls
// Heights above the middle of the body, which is the middle of the cell: in the drawing the body is from
// -5.73 to 3.85, the cavity reaches to 2.76, the hole in the stud to 3.42, the stud to 5.73.
constexpr double kMiddle = (3.85 - 5.73) / 2;
constexpr double kBottom = -5.73 - kMiddle, kCeiling = 2.76 - kMiddle, kHoleEnd = 3.42 - kMiddle,
                 kTop = 3.85 - kMiddle, kStudTop = 5.73 - kMiddle;
constexpr int kLongest = 10'000;

/// Frame: origin in the first cell's centre, run along +x.
PartMesh brick(const MeshRequest &request)
{
   if (request.length > kLongest)
      throw Failure(DIATOM_LIMIT,
                    "a brick of " + std::to_string(request.length) + " cells is too long to mesh");
   const int round = request.detail == 0 ? 12 : 64;
   const double side = kWidth / 2, inside = side - kWall;
   std::vector<Prism> lower, upper;
   for (int cell = 0; cell < request.length; ++cell) {
      const bool first = cell == 0, last = cell + 1 == request.length;
      const double middle = cell * kPitch;
      const double left = middle - (first ? side : kPitch / 2), right = middle + (last ? side : kPitch / 2);
      const double from = first ? left + kWall : left, to = last ? right - kWall : right;
      // Walls: solid up to the hole's end. Between them the cavity, with the stud's hole in its ceiling.
      lower.push_back({{{left, -side}, {right, -side}, {to, -inside}, {from, -inside}}, 3});
      lower.push_back({{{right, side}, {left, side}, {from, inside}, {to, inside}}, 3});
      if (first)
         lower.push_back({{{left, side}, {left, -side}, {from, -inside}, {from, inside}}, 3});
      if (last)
         lower.push_back({{{right, -side}, {right, side}, {to, inside}, {to, -inside}}, 3});
      const auto hole = circle({middle, 0}, kHoleRadius, round),
                 stud = circle({middle, 0}, kStudRadius, round);
      addSurround(lower, {from, -inside}, {to, inside}, hole, 2);
      lower.push_back({hole, 0});
      addSurround(upper, {left, -side}, {right, side}, stud, 1);
      upper.push_back({stud, 3});
   }
   PartMesh mesh;
   Prisms solid(mesh, request.pitch / kPitch);
   solid.add({kBottom, kCeiling, kHoleEnd}, lower, false, true);
   solid.add({kHoleEnd, kTop, kStudTop}, upper, true, false);
   return mesh;
}

void decompose(const Call &call, const diatom_cells &cells, PartList &parts)
{
   needHeight(cells, 1.17, "LEGO bricks");
   onePartPerRun(call, cells, parts);
}

PartSet gikLego(const Values &)
{
   PartSet set;
   set.kinds = {{"brick", "LEGO brick", 1}};
   set.lattices = {"org.diatom_cad.lattice.gik"};
   set.details = 2;
   set.mesh = brick;
   set.decompose = decompose;
   return set;
}

} // namespace

DIATOM_PARTS(gikLego)
