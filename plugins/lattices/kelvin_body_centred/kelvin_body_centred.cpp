// Truncated octahedra with unit edges that fill space, held together by their 6 squares and 8 hexagons.
// Layers are half a cube edge high; odd layers are shifted by half a cube edge in x and y.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice kelvinBodyCentred(const Values &)
{
   const double a = std::sqrt(2.0);
   Lattice l;
   l.period = {1, 1, 2};
   l.basis = {Vec{2 * a, 0, 0}, Vec{0, 2 * a, 0}, Vec{0, 0, a}};
   l.offset = {{0, 0, 0}, {a, a, 0}};
   l.shape = {hull(form({0, a / 2, a}))};
   l.touch = Touch::face;
   return l;
}
DIATOM_LATTICE(kelvinBodyCentred)
