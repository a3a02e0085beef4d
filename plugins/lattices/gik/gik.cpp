// Bricks of 1 x 1 x height cells that press together like LEGO: a brick runs along y in even layers and along
// x in odd ones, and only what lies above or below is held.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice gik(const Values &values)
{
   const double height = values.number("height");
   Lattice l;
   l.period = {1, 1, 2};
   l.basis = {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, height}};
   l.offset = {{0, 0, 0}, {0, 0, 0}};
   l.orientation = {turn({0, 0, 1}, 90), Turn{}};
   l.shape = {hull(signs({0.5, 0.5, height / 2}))};
   l.joined = [](std::int32_t, Step step, Touch contact) { return contact == Touch::face && step.k != 0; };
   l.supercellStep = {{0, 1, 0}, {1, 0, 0}};
   l.supercellDefault = 4;
   return l;
}
DIATOM_LATTICE(gik)
