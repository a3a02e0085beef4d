// Regular tetrahedra with unit edges, all with their base down, held together by their corners: face-centred
// cubic seen along a body diagonal, layers stacked A B C the other way round than flat octahedra. Odd rows
// are shifted by minus half a step in x.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice tetrahedronVertex(const Values &)
{
   const double h = 1 / std::sqrt(6.0), r = 1 / std::sqrt(3.0);
   Lattice l;
   l.period = {1, 2, 3};
   l.basis = {Vec{1, 0, 0}, Vec{0, std::sqrt(0.75), 0}, Vec{0, 0, 2 * h}};
   l.offset = {{0, 0, 0}, {0.5, r / 2, 0}, {0, r, 0}, {-0.5, 0, 0}, {0, r / 2, 0}, {-0.5, r, 0}};
   // About the centroid, a quarter of the height above the base: so a cell keeps all its 12 rotations.
   l.shape = {hull({{0, 0, 1.5 * h}, {0, r, -h / 2}, {0.5, -r / 2, -h / 2}, {-0.5, -r / 2, -h / 2}})};
   l.touch = Touch::vertex;
   return l;
}
DIATOM_LATTICE(tetrahedronVertex)
