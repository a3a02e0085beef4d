// Regular octahedra with unit edges lying on a triangle, held together by their edges: face-centred cubic
// seen along a body diagonal. Layers are stacked A B C: without the shift their corners would not meet. Odd
// rows are shifted by minus half a step in x.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice octahedronEdgeFlat(const Values &)
{
   const double h = 1 / std::sqrt(6.0), r = 1 / std::sqrt(3.0);
   Lattice l;
   l.period = {1, 2, 3};
   l.basis = {Vec{1, 0, 0}, Vec{0, std::sqrt(0.75), 0}, Vec{0, 0, 2 * h}};
   l.offset = {{0, 0, 0}, {0.5, -r / 2, 0}, {0, -r, 0}, {-0.5, 0, 0}, {0, -r / 2, 0}, {-0.5, -r, 0}};
   l.shape = {hull(
       {{0, -r, h}, {0.5, r / 2, h}, {-0.5, r / 2, h}, {0, r, -h}, {0.5, -r / 2, -h}, {-0.5, -r / 2, -h}})};
   l.touch = Touch::edge;
   return l;
}
DIATOM_LATTICE(octahedronEdgeFlat)
