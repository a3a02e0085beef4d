// Regular octahedra with unit edges lying on a triangle, stacked face to face in columns: odd layers are
// turned by half a turn about z, so that facing triangles coincide. Odd rows are shifted by minus half a step
// in x.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice octahedronFace(const Values &)
{
   const double h = 1 / std::sqrt(6.0), r = 1 / std::sqrt(3.0);
   Lattice l;
   l.period = {1, 2, 2};
   l.basis = {Vec{1, 0, 0}, Vec{0, std::sqrt(0.75), 0}, Vec{0, 0, 2 * h}};
   l.offset = {{0, 0, 0}, {0, 0, 0}, {-0.5, 0, 0}, {-0.5, 0, 0}};
   const Turn half = turn({0, 0, 1}, 180);
   l.orientation = {Turn{}, half, Turn{}, half};
   l.shape = {hull(
       {{0, -r, h}, {0.5, r / 2, h}, {-0.5, r / 2, h}, {0, r, -h}, {0.5, -r / 2, -h}, {-0.5, -r / 2, -h}})};
   l.touch = Touch::face;
   return l;
}
DIATOM_LATTICE(octahedronFace)
