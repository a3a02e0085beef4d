#include "equilibrium/readout.h"

#include "model/energy.h"

namespace bonds {

namespace {

enum Output {
   position,
   rotation,
   velocity,
   angularVelocity,
   internalForce,
   reaction,
   strain,
   energy,
   momentum
};

} // namespace

Readout::Readout(const Balance &balance, const std::vector<diatom_output> &more) : m_balance(&balance)
{
   const std::int64_t cells = balance.assembly().cells;
   m_output = {{"position", "m", cells, 3},
               {"rotation", "", cells, 4},
               {"velocity", "m/s", cells, 3},
               {"angular_velocity", "rad/s", cells, 3},
               {"internal_force", "N", cells, 6},
               {"reaction", "N", cells, 6},
               {"strain", "", cells, 1},
               {"energy", "J", 1, 6},
               {"momentum", "", 1, 6}};
   m_output.insert(m_output.end(), more.begin(), more.end());
   m_outputs = {sizeof(diatom_outputs), static_cast<std::int64_t>(m_output.size()), m_output.data()};
}

void Readout::read(const Reading &reading, std::int64_t output, std::int64_t first, std::int64_t count,
                   double *values) const
{
   const Assembly &assembly = m_balance->assembly();
   const State &state = reading.state;
   const auto columns = [&](int column, int stride) {
      for (std::int64_t i = 0; i < count; ++i)
         for (int k = 0; k < stride; ++k)
            values[i * stride + k] = state.column(column + k)[first + i];
   };
   switch (output) {
   case position:
      for (std::int64_t i = 0; i < count; ++i)
         for (int k = 0; k < 3; ++k)
            values[3 * i + k] = assembly.rest[k][first + i] + state.column(k)[first + i];
      break;
   case rotation:
      for (std::int64_t i = 0; i < count; ++i) {
         const Quat q = state.unitTurnOf(first + i);
         const double all[4] = {q.w, q.x, q.y, q.z};
         std::copy_n(all, 4, values + 4 * i);
      }
      break;
   case velocity:
      columns(7, 3);
      break;
   case angularVelocity:
      columns(10, 3);
      break;
   case internalForce:
      std::copy_n(reading.internal.data() + 6 * first, 6 * count, values);
      break;
   case reaction:
      std::copy_n(reading.reaction.data() + 6 * first, 6 * count, values);
      break;
   case strain: {
      const RestShape &rest = reading.loading.rest;
      const Column all = strains(assembly, state, rest.d[0].empty() ? nullptr : &rest);
      std::copy_n(all.begin() + first, count, values);
      break;
   }
   case energy:
      if (count == 1)
         std::copy_n(reading.energy.begin(), 6, values);
      break;
   case momentum: {
      const Momenta now = momenta(assembly, state);
      const double all[6] = {now.linear.x,  now.linear.y,  now.linear.z,
                             now.angular.x, now.angular.y, now.angular.z};
      if (count == 1)
         std::copy_n(all, 6, values);
      break;
   }
   default:
      break;
   }
}

Vector reactionOf(const Supports &supports, const Vector &unbalanced)
{
   return (supports.free().array() - 1) * unbalanced.array();
}

} // namespace bonds
