// Signals of the sources and what they do to the rest shape of bonds: length, shear, bend and twist of driven
// cells.
#pragma once

#include "model/state.h"

namespace bonds {

/// Rest strains of every bond in its own axes; empty columns when nothing is driven.
struct RestShape
{
   std::array<Column, 3> d, phi;
   Vec3 separation(std::int64_t i) const { return {d[0][i], d[1][i], d[2][i]}; }
   Vec3 turn(std::int64_t i) const { return {phi[0][i], phi[1][i], phi[2][i]}; }
};

/// Waveforms of amoeba.md 5.3, -amplitude/2 to +amplitude/2 volts.
struct Signal
{
   int waveform = 0; // sine, square, saw, triangle
   double frequency = 0, phase = 0, duty = 0.5, amplitude = 1;
   bool inverted = false; // saw: falls

   double at(double time) const;
};

class Actuation
{
public:
   Actuation(const sdk::SceneView &scene, const Assembly &assembly);
   bool active() const { return !m_bonds.empty(); }
   /// Of each bond, whether its rest shape may change; empty when nothing is driven.
   std::vector<bool> driven(std::int64_t bonds) const;
   void setSources(const sdk::Channel &sources);

   void setRest(double time, RestShape &rest) const;
   const RestShape &shape() const { return m_initial; }

   /// Rest shape of the driven bonds, one after another.
   using Shapes = std::vector<std::array<Vec3, 2>>;
   /// What the driven bonds see of their cells.
   void look(const Assembly &assembly, const State &state, std::vector<Relation> &seen) const;
   /// Elastic energy (J) that changing the rest shape from the accepted one to `rest` would add, the cells
   /// held where they were seen: the actuators' work.
   double energyChange(const Assembly &assembly, const std::vector<Relation> &seen,
                       const RestShape &rest) const;
   void accept(const RestShape &rest);
   const Shapes &accepted() const { return m_accepted; }
   /// Accepts what was so before, and shows it in `rest`.
   void acceptAgain(const Shapes &shapes, RestShape &rest);

private:
   struct Driver
   {
      double gain = 0;
      int plus = -1, minus = -1;
   };
   /// Strain of one driven cell on one of its bonds.
   struct Share
   {
      std::int64_t bond = 0; // number in m_bonds
      int driver = 0;
      Vec3 d, phi; // per unit of strain
   };
   void addDriver(const sdk::SceneView &scene, const Assembly &assembly, std::int64_t cell,
                  const double *row);

   std::vector<Signal> m_signals;
   std::vector<Driver> m_drivers;
   std::vector<Share> m_shares;
   std::vector<std::int64_t> m_bonds; // driven, ascending
   std::vector<double> m_length;
   Shapes m_accepted; // whose work is counted
   RestShape m_initial;
};

} // namespace bonds
