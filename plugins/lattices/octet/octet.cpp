// Octahedra and tetrahedra with unit edges that fill space, each octahedron's 8 faces on tetrahedra and each
// tetrahedron's 4 on octahedra. Octahedra have z = 0, 3, 6, .. and lie as in the lattice of octahedra joined
// by edges, every second layer of them shifted by minus half a step in x and y. The two indices above an
// octahedron are the tetrahedra over its edges towards +x and +y; both are at one height.
#include <diatom/lattice.hpp>

using namespace diatom::sdk;

static Lattice octet(const Values &)
{
   const double s = std::sqrt(0.5), third = s / 3;
   Lattice l;
   l.period = {1, 1, 6};
   l.basis = {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, third}};
   // Tetrahedra lie half a layer of octahedra above it, not one and two thirds.
   l.offset = {{0, 0, 0}, {0.5, 0, third / 2}, {0, 0.5, -third / 2}};
   for (int site = 0; site < 3; ++site)
      l.offset.push_back(l.offset[site] + Vec{-0.5, -0.5, 0});
   const Turn quarter = turn({0, 0, 1}, 90);
   l.orientation = {Turn{}, Turn{}, quarter, Turn{}, Turn{}, quarter};
   l.shape = {hull({{0.5, 0.5, 0}, {-0.5, 0.5, 0}, {-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0, 0, s}, {0, 0, -s}}),
              hull({{0, 0.5, -s / 2}, {0, -0.5, -s / 2}, {0.5, 0, s / 2}, {-0.5, 0, s / 2}})};
   l.shapeOfSite = {0, 1, 1, 0, 1, 1};
   l.touch = Touch::face;
   return l;
}
DIATOM_LATTICE(octet)
