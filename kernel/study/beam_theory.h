// Answers of beam theory that studies of accuracy are held against. None knows of cells or bonds.
#pragma once

#include <cstddef>

namespace diatom {

/// A straight uniform bar, clamped at one end. SI.
struct Bar
{
   double length = 0;
   double axial = 0;   // E A, N
   double shear = 0;   // k G A, N
   double bending = 0; // E I, N m2
   double mass = 0;    // kg per metre
   double turning = 0; // rotational inertia of a cross-section: rho I, kg m per metre

   /// Square cross-section with a shear coefficient of 5/6.
   static Bar square(double length, double width, double youngsModulus, double poissonRatio, double density);
};

/// Deflection at a distance from the clamp under a load (N/m) along the whole bar; small. Timoshenko's beam.
double sagOf(const Bar &bar, double load, double at);

struct TipPosition
{
   double along = 0, across = 0; // m; at rest along is the length
};

/// A force across the bar at its tip that keeps its direction; of any size. Reissner, "On one-dimensional
/// finite-strain beam theory: the plane problem", ZAMP 23, 1972: the beam stretches and shears as well.
TipPosition bentTip(const Bar &bar, double force);

/// Hz, lowest frequency of bending. Timoshenko, "On the correction for shear of the differential equation for
/// transverse vibrations of prismatic bars", Philosophical Magazine 41, 1921: shear and rotational inertia.
double bendingFrequency(const Bar &bar);

/// The shape that belongs to it: deflection (1 at the tip) and turn of the cross-section (rad per metre of
/// tip deflection) at a distance from the clamp.
struct BarShape
{
   double deflection = 0, turn = 0;
};
BarShape bendingShape(const Bar &bar, double frequency, double at);

} // namespace diatom
