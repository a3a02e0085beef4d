// Degrees of freedom that follow curves while all others move freely, and the work that it takes.
#pragma once

#include "equilibrium/supports.h"

namespace bonds {

/// A driven degree of freedom moves evenly through each step, to end exactly where its curve is then; the
/// bits that assembly.fixed has for it keep forces from moving it.
class Drive
{
public:
   Drive(const sdk::SceneView &scene, const Assembly &assembly);

   bool active() const { return m_supports != nullptr; }
   void setCurves(std::span<const diatom_channel> channels) { m_supports->setCurves(channels); }
   /// Degrees of freedom of one cell that are driven, bit by bit.
   struct Led
   {
      std::int64_t cell = 0;
      int mask = 0;
   };
   const std::vector<Led> &cells() const { return m_cells; }

   /// Puts the driven degrees of freedom where their curves are.
   void place(double time, State &state);
   /// Gives them the velocities that bring them to their curves' places at `time + dt`.
   void lead(const Assembly &assembly, double time, double dt, State &state);
   /// Ends the step; returns the part of the drives' work (J) that went into momentum.
   double arrive(const Assembly &assembly, double dt, State &state);

   /// Angles and displacements that the curves have brought about, to go back to.
   const Column &reached() const { return m_reached; }
   void goBack(const Column &reached) { m_reached = reached; }

private:
   std::shared_ptr<Supports> m_supports; // null when nothing is driven
   std::vector<Led> m_cells;
   Column m_reached, m_target; // by driven degree of freedom
   /// At the start of the step.
   struct Before
   {
      std::array<double, 6> velocity, momentum;
      Quat turn;
   };
   std::vector<Before> m_before; // by cell
};

} // namespace bonds
