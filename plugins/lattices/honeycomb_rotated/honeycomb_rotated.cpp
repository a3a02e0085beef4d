// Hexagonal prisms with unit edges lying along y that fill space, held together by their 8 faces. Layers are
// half a prism high; odd ones are shifted by minus half a step in x.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice honeycombRotated(const Values &)
{
   const double s = std::sqrt(0.75);
   std::vector<Vec> corners;
   for (const double y : {-0.5, 0.5})
      for (const Vec v :
           {Vec{1, y, 0}, Vec{0.5, y, s}, Vec{-0.5, y, s}, Vec{-1, y, 0}, Vec{-0.5, y, -s}, Vec{0.5, y, -s}})
         corners.push_back(v);
   Lattice l;
   l.period = {1, 1, 2};
   l.basis = {Vec{3, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, s}};
   l.offset = {{0, 0, 0}, {-1.5, 0, 0}};
   l.shape = {hull(corners)};
   l.touch = Touch::face;
   return l;
}
DIATOM_LATTICE(honeycombRotated)
