// Poisson's ratio between the axial strains of a cell, which makes a solid of a dense block of bonds.
//
// Consider the eight-node element on the centres of the eight cells around a corner of the lattice, its
// strain energy sampled at its nodes: each node stands for the octant that its cell reaches into the element.
// There the three edges of the element that meet at the node, which are bonds, give the displacement
// gradient. Let the strain of an edge be what its bond measures in its own middle frame: the axial strain,
// exact for any rotation, and the shear against the mean turn of its two cells. The turns of the cells then
// carry what makes an element of displacements alone lock in bending. Summed over the elements around an
// edge,
//  - the shear terms, with the cell's turn tied to the material's by a penalty of 2 G (Hughes and Brezzi,
//    Computer Methods in Applied Mechanics and Engineering 72, 1989), are 2 G (u' - t)^2 / 2 for each edge:
//    the bond with kappa = 2 G A / l (makeDense in model/constants.h);
//  - the axial terms are eps . C eps / 2 for each octant, of which the bonds' axial springs hold E eps^2 / 2;
//  - what is left for each octant is eps . (C - E) eps / 2 with the isotropic law C.
// An octant that no bond reaches into in some direction lies at a free face: there the stress in that
// direction is nothing, and C is condensed (plane stress; with one bond, E). Thus the outer half of every
// surface cell counts with its full stiffness, and free faces are free of stress.
// The octants of a cell share the mean of its two strains in each direction, so that one volume change
// belongs to one cell and Poisson ratios near a half do not lock; the energy of a cell becomes e . K e V / 2
// with the mean strains e and K the sum over octants of (C - E). K alone may be negative, but every octant's
// E eps^2 is at least E e^2 on average over the cell, so together with the bonds each cell holds at least e .
// C e V / 2.
//
// In a bond of unlike cells, each half has its share of the strain as springs in series have it.
#pragma once

#include "model/coupling.h"

#include "solid/stretch.h"

namespace bonds {

/// A symmetric matrix on the mean strains along x, y, z: xx, yy, zz, yz, zx, xy.
using Symmetric = std::array<double, 6>;

/// J that a cell of this volume holds per half square of its mean strains, beyond its bonds. `reach` is the
/// share of octants that a bond reaches into, in each direction: 0, 1/2 or 1.
Symmetric poissonStiffness(double youngsModulus, double poissonRatio, double volume,
                           const std::array<double, 3> &reach);

/// What the coupling needs to know of one cell.
struct CoupledCell
{
   std::int64_t cell = 0;
   double youngsModulus = 0, poissonRatio = 0, dampingRatio = 0, volume = 0;
   std::array<double, 3> area{}; // section across each world axis, m2
};

class CellCoupling final : public Coupling
{
public:
   CellCoupling(const Assembly &assembly, const std::vector<CoupledCell> &cells);

   double addForces(const sdk::Call &call, const State &state, const RestShape *rest,
                    CellForces &forces) const override;
   double energy(const State &state, const RestShape *rest) const override;
   void addStiffness(const State &state, const RestShape *rest, const AddBlock &add) const override;
   void addDamping(const State &state, const AddBlock &add) const override;
   void addRowSums(CellForces &stiffness, CellForces &damping) const override;

private:
   /// A cell's share of a bond's stretch (per m) in its mean strain and strain rate.
   struct Weight
   {
      double strain = 0, rate = 0;
   };
   /// A bond as one of its cells sees it: 2 * number in m_bond + (1 where the cell is its b).
   using Slot = std::int64_t;

   void listBonds();
   void addCell(const CoupledCell &cell);
   int axisOf(std::int64_t number) const { return m_assembly->axisOf(m_bond[number]); }
   std::int64_t cellAt(Slot slot) const
   {
      const std::int64_t bond = m_bond[slot / 2];
      return slot & 1 ? m_assembly->b[bond] : m_assembly->a[bond];
   }
   /// Actuated stretch at rest, m.
   double restOf(std::int64_t number, const RestShape *rest) const
   {
      return rest ? rest->d[0][m_bond[number]] - m_assembly->lengthOf(m_bond[number]) : 0;
   }
   BondEnds endsAt(const State &state, std::int64_t number) const; // in the bond's axes
   /// Mean strains of a coupled cell from stretches of all bonds, world axes.
   Vec3 meanOf(std::int64_t coupled, const Column &stretch, double Weight::*weight) const;
   void measure(const State &state, const RestShape *rest, std::int64_t begin, std::int64_t end) const;
   void strain(std::int64_t begin, std::int64_t end) const;
   double tensionOf(std::int64_t number, bool damped) const;
   void gather(CellForces &forces, std::int64_t begin, std::int64_t end) const;
   double power() const;
   void addProducts(const State &state, const std::vector<Symmetric> &matrix, double Weight::*weight,
                    const AddBlock &add) const;
   void addSums(std::int64_t coupled, const Symmetric &matrix, double Weight::*weight,
                CellForces &sums) const;

   const Assembly *m_assembly;
   std::vector<std::int64_t> m_cell;            // coupled, ascending
   std::vector<Symmetric> m_stiffness, m_loss;  // of each
   std::vector<std::int64_t> m_number;          // of each cell of the scene in m_cell, -1 for none
   std::vector<std::int64_t> m_bond;            // with a coupled end, ascending
   std::array<std::vector<Weight>, 2> m_weight; // of ends a and b
   std::vector<std::int64_t> m_first;           // slots of each cell of the scene
   std::vector<Slot> m_slot;
   bool m_damped = false;

   /// Room for one evaluation, by bond and by coupled cell.
   struct Room
   {
      Column stretch, rate, tension;
      std::array<Column, 9> gradient; // along, turnA, turnB, world axes
      std::array<Column, 3> stress, loss;
   };
   mutable Room m_room;
};

} // namespace bonds
