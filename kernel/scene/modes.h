// Vibrations of a scene about its static balance.
#pragma once

#include "scene/balance.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace diatom {

struct Mode
{
   enum class Kind : std::uint8_t {
      vibration,
      neutral, // nothing brings it back: a body that is free to move as a whole, or a mechanism
      unstable // the balance is one that the smallest push leaves, like a column beyond its buckling load
   };
   Kind kind = Kind::vibration;
   double eigenvalue = 0; // rad2/s2
   double hertz = 0;      // of a vibration; 0 otherwise
};

struct Modes
{
   std::unique_ptr<SolverRun> run;
   std::vector<Mode> modes;     // by ascending eigenvalue
   double residual = 0;         // of the balance they are about
   std::int64_t iterations = 0; // to find it

   /// Displacement (m) and turn (rad) of each cell, six numbers, of unit modal mass.
   Result<std::vector<double>> shape(std::size_t mode, const Job &job) const;
};

/// The scene is built for Analysis::modes; the solver's value "modes" says how many are sought. Errors as of
/// solveStatics().
Result<Modes> findModes(std::shared_ptr<const Catalogue> catalogue, std::unique_ptr<Scene> scene,
                        const Setup &setup, const Values &values, const BalanceRequest &request,
                        const Job &job);

/// What an eigenvalue means, where `lastPlace` (rad2/s2) is the last place of the scene's largest one: from a
/// thousand of them below zero to one above, it is taken for zero.
Mode modeOf(double eigenvalue, double lastPlace);

} // namespace diatom
