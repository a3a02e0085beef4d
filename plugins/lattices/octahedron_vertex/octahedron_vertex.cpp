// Regular octahedra with unit edges standing on a corner on a simple cubic grid, held together by their
// corners; what they leave empty are cuboctahedra.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice octahedronVertex(const Values &)
{
   const double a = std::sqrt(2.0);
   Lattice l;
   l.basis = {Vec{a, 0, 0}, Vec{0, a, 0}, Vec{0, 0, a}};
   l.shape = {hull(form({0, 0, a / 2}))};
   l.touch = Touch::vertex;
   return l;
}
DIATOM_LATTICE(octahedronVertex)
