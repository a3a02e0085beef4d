// Unit cubes that fill space, held together by their faces.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice cube(const Values &)
{
   Lattice l;
   l.shape = {hull(signs({0.5, 0.5, 0.5}))};
   l.touch = Touch::face;
   return l;
}
DIATOM_LATTICE(cube)
