// Rhombic dodecahedra with unit edges that fill space, held together by their 12 faces: face-centred cubic
// seen along a cube axis, numbered as the octahedra joined by edges. Odd layers are shifted by minus half a
// step in x and y.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice rhombicDodecahedron(const Values &)
{
   const double h = 1 / std::sqrt(3.0), s = std::sqrt(2.0) * h;
   std::vector<Vec> corners{{0, 0, 2 * h}, {0, 0, -2 * h}, {s, s, 0}, {-s, s, 0}, {-s, -s, 0}, {s, -s, 0}};
   for (const double z : {-h, h})
      for (const Vec v : {Vec{s, 0, z}, Vec{0, s, z}, Vec{-s, 0, z}, Vec{0, -s, z}})
         corners.push_back(v);
   Lattice l;
   l.period = {1, 1, 2};
   l.basis = {Vec{2 * s, 0, 0}, Vec{0, 2 * s, 0}, Vec{0, 0, 2 * h}};
   l.offset = {{0, 0, 0}, {-s, -s, 0}};
   l.shape = {hull(corners)};
   l.touch = Touch::face;
   return l;
}
DIATOM_LATTICE(rhombicDodecahedron)
