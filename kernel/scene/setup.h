// What a simulation is told beyond the assembly: supports, loads, sources, ground, and how to step. SI.
#pragma once

#include "core/index.h"
#include "core/vec.h"
#include "plugins/values.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
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

/// Degrees of freedom held at rest: bit 0-2 translation x y z, bit 3-5 rotation.
struct Support
{
   Index cell;
   std::uint8_t fixed = 0x3f;
   friend bool operator==(const Support &, const Support &) = default;
};

/// A constant force (N) and moment (N m) on a cell, world axes.
struct Load
{
   Index cell;
   std::array<double, 3> force{}, moment{};
   friend bool operator==(const Load &, const Load &) = default;
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
   std::vector<Support> supports;          // sorted by cell, each cell once
   std::vector<Load> loads;
   std::vector<Source> sources;
   Ground ground;
   double drag = 0; // 1/s: slows all motion in proportion to mass; for settling
   double step = 0; // s the document asks for; 0 = the solver's stable step
   std::string solver = "org.diatom_cad.solver.bonds";
   Values solverValues;
   std::vector<Reference> references;
   /// Effects forced on (true) or off (false); all others are decided by the planner.
   std::map<std::string, bool> effects;
   friend bool operator==(const Setup &, const Setup &) = default;
};

} // namespace diatom
