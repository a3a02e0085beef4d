// What a simulation is told beyond the assembly: supports, drives, loads, sources, ground, and how to step.
// SI.
#pragma once

#include "core/index.h"
#include "core/vec.h"
#include "plugins/values.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace diatom {

enum class Waveform : std::uint8_t { sine, square, saw, triangle };

/// A signal generator in a source cell. Spans -amplitude/2 .. +amplitude/2 volts (amoeba.md 5.3).
struct Source
{
   Index cell;
   Waveform waveform = Waveform::sine;
   double frequency = 10; // Hz
   double phase = 0;      // turns, 0 to 1
   double duty = 0.5;     // of a square wave, 0 to 1
   bool inverted = false; // falling saw
   double amplitude = 1;  // V peak to peak
   friend bool operator==(const Source &, const Source &) = default;
};

/// Every cell of one material, those of composites included.
struct OfMaterial
{
   std::string id;
   friend bool operator==(const OfMaterial &, const OfMaterial &) = default;
};

/// The cells that a support, drive, load or start is on: one cell, the cells in a box, or those of a
/// material.
using Where = std::variant<Index, Box, OfMaterial>;

/// Degrees of freedom of a cell in the order of their numbers and mask bits.
inline constexpr std::array<const char *, 6> kFreedoms{"x", "y", "z", "rx", "ry", "rz"};
inline constexpr std::uint8_t kAllFreedoms = 0x3f;

/// Degrees of freedom held at rest: bit 0-2 translation x y z, bit 3-5 rotation. Several supports of one cell
/// hold together what each holds.
struct Support
{
   Where where;
   std::uint8_t fixed = kAllFreedoms;
   friend bool operator==(const Support &, const Support &) = default;
};

struct CurvePoint
{
   double time = 0, value = 0;
   friend bool operator==(const CurvePoint &, const CurvePoint &) = default;
};

/// Straight between its points, constant before the first and after the last; times ascend.
using Curve = std::vector<CurvePoint>;

/// One degree of freedom of each cell that follows a curve: displacement since rest (m), or turn since rest
/// about that world axis (rad). It may not be held as well, nor follow two curves.
struct Drive
{
   Where where;
   int freedom = 0; // number in kFreedoms
   Curve curve;
   friend bool operator==(const Drive &, const Drive &) = default;
};

/// A constant force (N) and moment (N m) on each of the cells, world axes. Loads of one cell add up.
struct Load
{
   Where where;
   std::array<double, 3> force{}, moment{};
   friend bool operator==(const Load &, const Load &) = default;
};

/// How each of the cells starts; turns are rotation vectors, world axes. With `about`, a point at rest, the
/// cells start as one rigid body: its turn and spin are about that point, and also displace and move what
/// lies off it. Starts of one cell add up; a freedom that is held or driven starts as its support or curve
/// says.
struct Start
{
   Where where;
   std::array<double, 3> displacement{};       // m since rest
   std::array<double, 3> turn{};               // rad since rest
   std::array<double, 3> velocity{};           // m/s
   std::array<double, 3> spin{};               // rad/s
   std::optional<std::array<double, 3>> about; // m
   friend bool operator==(const Start &, const Start &) = default;
};

/// Numbers by a name that some solver knows, as a temperature: inputs that Diatom itself knows nothing of.
/// SI.
struct Field
{
   Where where;
   std::string name;
   std::vector<double> values; // for each of the cells
   friend bool operator==(const Field &, const Field &) = default;
};

struct Ground
{
   bool present = false;
   double height = 0;       // m: plane z = height that cells' lower faces rest on
   double stiffness = 1000; // N/m per cell
   double damping = 0.1;    // N s/m per cell
   double friction = 0.5;   // Coulomb coefficient; 0 = none
   friend bool operator==(const Ground &, const Ground &) = default;
};

/// An answer known from elsewhere, that studies of accuracy hold runs against.
struct Reference
{
   std::string quantity; // "X,Y,Z:CHANNEL@SECONDS", "...@rest" or "...@frequency"
   double value = 0;     // SI
   std::string source;   // who says so
   friend bool operator==(const Reference &, const Reference &) = default;
};

struct Setup
{
   std::array<double, 3> gravity{0, 0, 0}; // m/s2
   std::vector<Support> supports;          // cells in order, then boxes, then materials
   std::vector<Drive> drives;
   std::vector<Load> loads;
   std::vector<Start> starts;
   std::vector<Field> fields;
   std::vector<Source> sources;
   Ground ground;
   double drag = 0;  // 1/s: slows all motion in proportion to mass; for settling
   double step = 0;  // s the document asks for; 0 = the solver's stable step
   double until = 0; // s that a run is to last; 0 = until it is stopped
   std::string solver = "org.diatom_cad.solver.bonds";
   Values solverValues;
   std::vector<Reference> references;
   /// Effects forced on (true) or off (false); all others are decided by the planner.
   std::map<std::string, bool> effects;
   friend bool operator==(const Setup &, const Setup &) = default;
};

} // namespace diatom
