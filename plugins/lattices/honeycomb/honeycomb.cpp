// Upright hexagonal prisms with unit edges that fill space, held together by their 8 faces. Odd rows are
// shifted by minus half a step in x.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice honeycomb(const Values &)
{
   const double s = std::sqrt(0.75);
   std::vector<Vec> corners;
   for (const double z : {-0.5, 0.5})
      for (const Vec v :
           {Vec{0, 1, z}, Vec{s, 0.5, z}, Vec{s, -0.5, z}, Vec{0, -1, z}, Vec{-s, -0.5, z}, Vec{-s, 0.5, z}})
         corners.push_back(v);
   Lattice l;
   l.period = {1, 2, 1};
   l.basis = {Vec{2 * s, 0, 0}, Vec{0, 1.5, 0}, Vec{0, 0, 1}};
   l.offset = {{0, 0, 0}, {-s, 0, 0}};
   l.shape = {hull(corners)};
   l.touch = Touch::face;
   return l;
}
DIATOM_LATTICE(honeycomb)
