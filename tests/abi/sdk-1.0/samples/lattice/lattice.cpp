// Towers with a square base, stacked and side by side, held together by their faces.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice towers(const Values &values)
{
   const double height = values.number("height");
   Lattice lattice;
   lattice.basis = {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, height}};
   lattice.shape = {hull(signs({0.5, 0.5, height / 2}))};
   lattice.touch = Touch::face;
   return lattice;
}
DIATOM_LATTICE(towers)
