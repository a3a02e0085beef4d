// Cuboctahedra with unit edges on a simple cubic grid, held together by their 6 squares; what they leave
// empty are octahedra.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice cuboctahedron(const Values &)
{
   const double a = std::sqrt(2.0);
   Lattice l;
   l.basis = {Vec{a, 0, 0}, Vec{0, a, 0}, Vec{0, 0, a}};
   l.shape = {hull(form({0, a / 2, a / 2}))};
   l.touch = Touch::face;
   return l;
}
DIATOM_LATTICE(cuboctahedron)
