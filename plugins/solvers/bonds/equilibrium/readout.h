// What can be read of a scene between two steps: the outputs that statics, modes and implicit motion share.
#pragma once

#include "equilibrium/balance.h"

#include <array>

namespace bonds {

/// One moment.
struct Reading
{
   const State &state;
   const Loading &loading;
   const Vector &internal, &reaction; // 6 a cell
   std::array<double, 6> energy; // kinetic, elastic, gravity, contact, dissipated, work; J. Only for kEnergy
};

class Readout
{
public:
   /// `more` follow the shared ones.
   Readout(const Balance &balance, const std::vector<diatom_output> &more);
   Readout(const Readout &) = delete;
   Readout &operator=(const Readout &) = delete;

   static constexpr std::int64_t kEnergy = 7, kShared = 9; // number of that output; of shared outputs
   const diatom_outputs &outputs() const { return m_outputs; }
   void read(const Reading &reading, std::int64_t output, std::int64_t first, std::int64_t count,
             double *values) const;

private:
   const Balance *m_balance;
   std::vector<diatom_output> m_output;
   diatom_outputs m_outputs{};
};

/// What supports supply: the force out of balance where a degree of freedom is held, 0 where it is free.
Vector reactionOf(const Supports &supports, const Vector &unbalanced);

} // namespace bonds
