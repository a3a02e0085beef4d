// Elongated dodecahedra, the one of Fedorov's five parallelohedra that a cube, a hexagonal prism, a rhombic
// dodecahedron and a truncated octahedron are not: a rhombic dodecahedron with unit edges, cut at its middle
// and drawn apart by `length`. They fill space; odd layers lie half a step aside.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice elongatedDodecahedron(const Values &values)
{
   const double a = std::sqrt(6) / 3,
                b = 1 / std::sqrt(3); // half a side of the waist, half a step in height of a rhombus
   const double h = values.number("length");
   std::vector<Vec> corners;
   for (const double up : {1.0, -1.0}) {
      corners.push_back({0, 0, up * (h / 2 + 2 * b)});
      for (const Vec v : {Vec{a, 0, 0}, Vec{0, a, 0}, Vec{-a, 0, 0}, Vec{0, -a, 0}})
         corners.push_back(v + Vec{0, 0, up * (h / 2 + b)});
      for (const Vec v : {Vec{a, a, 0}, Vec{-a, a, 0}, Vec{-a, -a, 0}, Vec{a, -a, 0}})
         corners.push_back(v + Vec{0, 0, up * h / 2});
   }
   Lattice l;
   l.period = {1, 1, 2};
   l.basis = {Vec{2 * a, 0, 0}, Vec{0, 2 * a, 0}, Vec{0, 0, 2 * b + h}};
   l.offset = {{0, 0, 0}, {-a, -a, 0}};
   l.shape = {hull(corners)};
   l.touch = Touch::face;
   return l;
}
DIATOM_LATTICE(elongatedDodecahedron)
