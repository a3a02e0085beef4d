// The hard cases' scenes.
#pragma once

#include "document/design.h"

#include <cstdint>

namespace diatom::stability {

inline constexpr double kPitch = 1e-3; // m

Material stuff(const char *id, double density, double youngsModulus, double dampingRatio = 0);
Material rubber(double dampingRatio = 0); // 1200 kg/m3, 2 MPa
Material aluminium();                     // 2700 kg/m3, 69 GPa
Material steel();                         // 7850 kg/m3, 210 GPa

/// m/s: sqrt(E / density).
double soundSpeed(const Material &material);

/// Cells 0 to `size` - 1 along each axis, nothing held.
Design block(Index size, const Material &material);
/// The block whose upper half along x is of another material.
Design halves(Index size, const Material &lower, const Material &upper);

/// Cells that lie in a plane across an axis.
Box layer(Index size, int axis, std::int32_t at);
void hold(Design &design, const Box &where);
/// A speed of its own for each cell, m/s, up to `speed` along each axis: the same for the same seed.
void shake(Design &design, Index size, double speed, std::uint32_t seed);
/// The upper half along x sets out across.
void kick(Design &design, Index size, double speed);
/// All cells turn as one body about the axis z through the block's middle, rad/s.
void spin(Design &design, Index size, double rate);
/// A row of cells along x starts as an arc in the plane of x and z that turns by `angle` (rad) from its first
/// to its last cell.
void bendToArc(Design &design, int cells, double angle);
/// A row of actuators along x between its two held ends, driven by a wave; wires run beside them.
Design drivenRow(int cells, Waveform wave, double hertz, double strain, const Material &muscle);

/// Scenes of several rows, free but for the beam. Halves 1 : `ratio` in stiffness; a cube whose rim moves at
/// a part of the speed of sound; a beam of 40 cells let go from an arc of 60 degrees.
Design shakenHalves(double ratio);
Design shakenMetals();
Design spinningCube(double ofSound);
Design releasedBeam();

} // namespace diatom::stability
