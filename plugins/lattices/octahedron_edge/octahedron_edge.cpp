// Regular octahedra with unit edges standing on a corner, held together by their edges: face-centred cubic,
// seen along a cube axis. Two layers of cells overlap in height; odd layers are shifted by minus half a step
// in x and y.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice octahedronEdge(const Values &)
{
   const double s = std::sqrt(0.5);
   Lattice l;
   l.period = {1, 1, 2};
   l.basis = {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, s}};
   l.offset = {{0, 0, 0}, {-0.5, -0.5, 0}};
   l.shape = {hull({{0.5, 0.5, 0}, {-0.5, 0.5, 0}, {-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0, 0, s}, {0, 0, -s}})};
   l.touch = Touch::edge;
   return l;
}
DIATOM_LATTICE(octahedronEdge)
