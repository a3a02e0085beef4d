// Truncated octahedra with unit edges on a simple cubic grid; each touches 6 others through its squares and
// half of space stays empty.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice kelvin(const Values &)
{
   const double a = std::sqrt(2);
   Lattice l;
   l.basis = {Vec{2 * a, 0, 0}, Vec{0, 2 * a, 0}, Vec{0, 0, 2 * a}};
   l.shape = {hull(form({0, a / 2, a}))};
   l.touch = Touch::face;
   return l;
}
DIATOM_LATTICE(kelvin)
