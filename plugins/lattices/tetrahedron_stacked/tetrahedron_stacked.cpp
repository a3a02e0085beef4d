// Regular tetrahedra with unit edges in flat layers that meet base to base and tip to tip by turns. A cell's
// centre is at half its height (not its centroid), so that layers are equally spaced. Odd rows are shifted by
// minus half a step in x.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice tetrahedronStacked(const Values &)
{
   const double h = 1 / std::sqrt(6.0), r = 1 / std::sqrt(3.0);
   const Vec row{-0.5, 0, 0};
   Lattice l;
   l.period = {1, 2, 4};
   l.basis = {Vec{1, 0, 0}, Vec{0, std::sqrt(0.75), 0}, Vec{0, 0, 2 * h}};
   l.offset = {{}, {}, {}, {}, row, row, row, row};
   // Base down with a corner at +y, base up at -y, base down at -y, base up at +y.
   const Turn layers[] = {Turn{}, turn({1, 0, 0}, 180), turn({0, 0, 1}, 180), turn({0, 1, 0}, 180)};
   for (int site = 0; site < 8; ++site)
      l.orientation.push_back(layers[site % 4]);
   l.shape = {hull({{0, 0, h}, {0, r, -h}, {0.5, -r / 2, -h}, {-0.5, -r / 2, -h}})};
   // Every contact holds: by faces alone there would only be pairs of cells.
   l.joined = [](std::int32_t, Step, Touch) { return true; };
   return l;
}
DIATOM_LATTICE(tetrahedronStacked)
