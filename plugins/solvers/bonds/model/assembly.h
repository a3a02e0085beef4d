// What a scene is compiled to: masses, bonds in structure-of-arrays form sorted by direction, and who holds
// which bond.
#pragma once

#include "model/bond_table.h"

#include <diatom/solver.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace bonds {

namespace sdk = diatom::sdk;
using Column = std::vector<double>;

/// How the user asked for it.
struct Options
{
   enum class Integrator { semiImplicit, verlet, rungeKutta, midpoint, forwardEuler, implicit };
   Integrator integrator = Integrator::semiImplicit;
   Beam beam = Beam::timoshenko;
   bool stepped = true; // bonds between unlike cells are stepped beams
   bool exact = true;
   enum class Precision { f64, f32 };
   Precision precision = Precision::f64;
   bool reproducible = false; // the same bits on any instruction set
   enum class Instructions { best, avx2, sse4, scalar };
   Instructions instructions = Instructions::best;
   bool trueLimit = false; // the stable step from the eigenvalues of the whole scene
   double safety = 0.9;
   bool forceStep = false;

   static Options from(const sdk::Values &values);
};

struct Ground
{
   double height = 0, stiffness = 0, damping = 0, friction = 0;
};

/// Immutable once built. Vectors of three are columns by world axis.
struct Assembly
{
   Assembly(const sdk::SceneView &scene, const Options &options);

   std::int64_t cells = 0, links = 0;

   // Cells.
   std::array<Column, 3> rest;       // m
   Column mass;                      // kg
   std::vector<std::uint8_t> fixed;  // degrees of freedom, bit by bit, that forces do not move
   Column halfHeight;                // m, centre to lower face at rest; empty without ground
   bool boxes = false;               // some cell is no cube: its inertia turns with it
   std::array<Column, 3> boxInertia; // principal, in the cell's own axes; empty without `boxes`
   std::vector<Quat> orientation;    // own axes to world at rest; likewise
   Column inertia;                   // of cubes; the smallest of boxes

   // Bonds: first those along x, then y, z, then any other direction. a to b points along the positive axis.
   std::array<std::int64_t, 5> group{};
   std::vector<std::int32_t> a, b;
   std::vector<std::int32_t> link; // the scene's number
   BondTable constants;
   std::vector<Mat3> frame; // rows are the bond's axes; only of the last group

   // Bonds of each cell: 2 * bond + (1 where the cell is b), in bond order.
   std::vector<std::uint32_t> first;
   std::vector<std::uint32_t> bondsOf;

   Law law = Law::exact;

   // Effects that the scene calls for.
   bool damped = false, coupled = false, actuated = false, hasGravity = false, hasDrag = false,
        hasLoads = false;
   bool hasGround = false, hasFriction = false;
   std::array<double, 3> gravity{};
   double drag = 0;
   Ground ground;
   std::vector<std::array<double, 6>> velocity; // initial, empty when none

   /// 0 where held or driven; inertias of boxes as those of a cube with their smallest one.
   double inverseMass(std::int64_t cell, int axis) const
   {
      return (fixed[cell] >> axis & 1) ? 0 : 1 / mass[cell];
   }
   double inverseInertia(std::int64_t cell, int axis) const
   {
      return (fixed[cell] >> (3 + axis) & 1) ? 0 : 1 / inertia[cell];
   }
   /// m, at rest.
   double lengthOf(std::int64_t bond) const { return constants.length(bond); }
   int axisOf(std::int64_t bond) const
   {
      return bond < group[1] ? 0 : bond < group[2] ? 1 : bond < group[3] ? 2 : 3;
   }
   /// World to bond axes.
   Mat3 frameOf(std::int64_t bond) const;

private:
   void readCells(const sdk::SceneView &scene);
   void readSupports(const sdk::SceneView &scene);
   void readEffects(const sdk::SceneView &scene);
   void readBonds(const sdk::SceneView &scene, const Options &options);
   void indexBonds();
};

} // namespace bonds
