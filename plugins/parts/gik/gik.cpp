// GIK micro-LEGO: a run of L cells is one upright plate with slots at every cell centre, cut from above and
// below, into which the crossing plates of the next layers go. Measures: DMDesign's part, mm at its pitch
// of 1.27 mm. The coarse mesh has no slots: the plates that cross there fill them.
#include <diatom/part_runs.hpp>
#include <diatom/part_shapes.hpp>

#include <cmath>

using namespace diatom::sdk;

namespace {

constexpr double kPitch = 1.27;      // mm, one lattice unit
constexpr double kInset = 0.0635;    // each end stops short of the cell wall
constexpr double kThickness = 0.254; // of the plate, and width of a slot: 0.2 pitch
constexpr double kHeight = 3.175;
constexpr double kSlotDepth = 0.7744;
constexpr int kLongest = 1'000'000; // a plate of 10^6 cells has 3 * 10^7 triangles

/// Grid of the plate's outline: columns alternate solid, slot, solid, .. ; the middle one of three bands is
/// solid.
struct Outline
{
   std::vector<double> x;
   std::array<double, 4> z{-kHeight / 2, -kHeight / 2 + kSlotDepth, kHeight / 2 - kSlotDepth, kHeight / 2};

   explicit Outline(int length)
   {
      x.push_back(-kPitch / 2 + kInset);
      for (int cell = 0; cell < length; ++cell) {
         x.push_back(cell * kPitch - kThickness / 2);
         x.push_back(cell * kPitch + kThickness / 2);
      }
      x.push_back((length - 1) * kPitch + kPitch / 2 - kInset);
   }
   int columns() const { return static_cast<int>(x.size()) - 1; }
   bool solid(int column, int band) const
   {
      return column >= 0 && column < columns() && band >= 0 && band < 3 && (band == 1 || column % 2 == 0);
   }
};

/// Frame: origin in the first cell's centre, run along +x, plate in the x-z plane.
PartMesh plate(const MeshRequest &request)
{
   if (request.length > kLongest)
      throw Failure(DIATOM_LIMIT,
                    "a brick of " + std::to_string(request.length) + " cells is too long to mesh");
   const double scale = request.pitch / kPitch;
   PartMesh mesh;
   if (request.detail == 0) {
      const double left = -kPitch / 2 + kInset, right = (request.length - 0.5) * kPitch - kInset,
                   y = kThickness / 2;
      Prisms(mesh, scale)
          .add({-kHeight / 2, kHeight / 2}, {{{{left, -y}, {right, -y}, {right, y}, {left, y}}, 1}});
      return mesh;
   }
   const Outline outline(request.length);
   for (const double x : outline.x)
      for (const double z : outline.z)
         for (const double y : {-kThickness / 2, kThickness / 2})
            mesh.vertex(x * scale, y * scale, z * scale);
   const auto corner = [](int column, int band, int back) { return (column * 4 + band) * 2 + back; };
   for (int i = 0; i < outline.columns(); ++i)
      for (int k = 0; k < 3; ++k) {
         if (!outline.solid(i, k))
            continue;
         mesh.quad(corner(i, k, 0), corner(i + 1, k, 0), corner(i + 1, k + 1, 0), corner(i, k + 1, 0));
         mesh.quad(corner(i, k, 1), corner(i, k + 1, 1), corner(i + 1, k + 1, 1), corner(i + 1, k, 1));
         if (!outline.solid(i - 1, k))
            mesh.quad(corner(i, k, 0), corner(i, k + 1, 0), corner(i, k + 1, 1), corner(i, k, 1));
         if (!outline.solid(i + 1, k))
            mesh.quad(corner(i + 1, k, 0), corner(i + 1, k, 1), corner(i + 1, k + 1, 1),
                      corner(i + 1, k + 1, 0));
         if (!outline.solid(i, k - 1))
            mesh.quad(corner(i, k, 0), corner(i, k, 1), corner(i + 1, k, 1), corner(i + 1, k, 0));
         if (!outline.solid(i, k + 1))
            mesh.quad(corner(i, k + 1, 0), corner(i + 1, k + 1, 0), corner(i + 1, k + 1, 1),
                      corner(i, k + 1, 1));
      }
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
