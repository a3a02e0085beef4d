// What the vector kernel leaves to be done for single cells in the middle of a tile: contact, friction's
// springs, and the work of drives.
#include "explicit/vector_motion.h"

namespace bonds {

template<typename T>
void VectorMotion<T>::visitDriven(Visit &visit, std::uint32_t place, const T *lo, const T *hi,
                                  std::size_t hiStride)
{
   const auto found = std::lower_bound(m_drivenPlaces.begin(), m_drivenPlaces.end(), place,
                                       [](const DrivenPlace &a, std::uint32_t b) { return a.place < b; });
   const Assembly &assembly = *m_assembly;
   const std::int64_t cell = found->led.cell;
   /// Momenta that drag acts on, at the velocities that the cell has or, where it is driven, gets.
   const auto dragged = [&](bool led) {
      double v[6];
      for (int k = 0; k < 6; ++k)
         v[k] = led && (found->led.mask >> k & 1)
                    ? m_state.column(7 + k)[cell]
                    : static_cast<double>(m_sweep.rate[static_cast<std::size_t>(k) * m_sweep.stride + place]);
      const Vec3 move = assembly.mass[cell] * Vec3{v[0], v[1], v[2]},
                 turn = spinMomentum(assembly, cell, m_state.turnOf(cell), {v[3], v[4], v[5]});
      return std::array<double, 6>{move.x, move.y, move.z, turn.x, turn.y, turn.z};
   };
   const auto old = dragged(false), led = dragged(true);
   const bool euler = m_integrator == Options::Integrator::semiImplicit;
   for (int k = 0; k < 6; ++k) {
      if (!(found->led.mask >> k & 1))
         continue;
      const double now = m_state.column(7 + k)[cell];
      double force = static_cast<double>(lo[static_cast<std::size_t>(k) * kChunk] +
                                         hi[static_cast<std::size_t>(k) * hiStride]);
      if (!m_loads.empty())
         force += m_loads[6 * static_cast<std::size_t>(cell) + static_cast<std::size_t>(k)];
      if (assembly.hasGravity && k < 3)
         force += assembly.mass[cell] * assembly.gravity[k];
      const auto at = static_cast<std::size_t>(k);
      if (euler)
         visit.sums.work -= m_behind * (force - m_sweep.drag * old[at]) * found->before[at] +
                            0.5 * visit.move.kick * (force - m_sweep.drag * led[at]) * now;
      else
         visit.sums.work -= visit.weight * (force - m_sweep.drag * old[at]) * now;
      column(7 + k)[place] = static_cast<T>(now);
   }
}

/// Of the cells [begin, begin + count), those that touch the ground or whose friction springs are stretched
/// where that counts; false where there are none.
template<typename T>
bool VectorMotion<T>::findTouching(std::uint32_t begin, std::uint32_t count, std::uint8_t *touches,
                                   bool gripping) const
{
   const T *height = column(2) + begin, *ground = m_touching.data() + begin;
   const std::uint8_t *grips = m_gripping.data() + begin;
   std::uint8_t any = 0;
   for (std::uint32_t i = 0; i < count; ++i) {
      touches[i] = ground[i] - height[i] > 0 || (gripping && grips[i] != 0);
      any |= touches[i];
   }
   return any != 0;
}

/// `speeds`: of velocity and spin, six columns.
template<typename T>
Touch VectorMotion<T>::touchAt(std::uint32_t place, std::int64_t cell, const T *speeds)
{
   const Assembly &assembly = *m_assembly;
   const double h = assembly.halfHeight[cell];
   const auto speed = [&](std::size_t k) { return static_cast<double>(speeds[k * m_sweep.stride + place]); };
   Touch touch{assembly.ground.height - (assembly.rest[2][cell] + static_cast<double>(column(2)[place]) - h),
               speed(2),
               {speed(0) - h * speed(4), speed(1) + h * speed(3)},
               h,
               {}};
   for (std::size_t j = 0; j < 2 && assembly.hasFriction; ++j)
      touch.grip[j] = &m_state.grip[j][cell];
   return touch;
}

/// Contact of a chunk's cells, before they are kicked.
template<typename T>
void VectorMotion<T>::visitTouching(Visit &visit, std::uint32_t begin, std::uint32_t end, T *lo)
{
   const Assembly &assembly = *m_assembly;
   std::uint8_t touches[kChunk];
   if (!findTouching(begin, end - begin, touches, assembly.hasFriction))
      return;
   for (std::uint32_t i = 0; i < end - begin; ++i) {
      const std::int64_t cell = touches[i] ? m_layout.cell[begin + i] : -1;
      if (cell < 0)
         continue;
      const Touch touch = touchAt(begin + i, cell, m_sweep.rate);
      Vec3 force, torque;
      addContact(assembly.ground, touch, visit.ahead, visit.weight, force, torque, visit.sums);
      if (visit.move.last && assembly.hasFriction)
         driftContact(assembly.ground, touch, visit.move.drift, visit.sums);
      if (assembly.hasFriction)
         m_gripping[begin + i] = grips(cell);
      const double all[6] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
      for (std::size_t k = 0; k < 6; ++k)
         lo[k * kChunk + i] += static_cast<T>(all[k]);
   }
}

/// Contact and drives, before a chunk's cells are kicked.
template<typename T>
void VectorMotion<T>::visitBefore(Visit &visit, std::uint32_t begin, std::uint32_t end, T *lo, const T *hi,
                                  std::size_t hiStride)
{
   if (m_assembly->hasGround)
      visitTouching(visit, begin, end, lo);
   if (m_drivenPlaces.empty() || visit.move.predict)
      return;
   for (std::uint32_t place = begin; place < end; ++place)
      if (const auto found =
              std::lower_bound(m_drivenPlaces.begin(), m_drivenPlaces.end(), place,
                               [](const DrivenPlace &a, std::uint32_t b) { return a.place < b; });
          found == m_drivenPlaces.end())
         return;
      else if (found->place == place)
         visitDriven(visit, place, lo + (place - begin), hi + (place - begin), hiStride);
}

/// Friction springs go along with the contact points for `dt`.
template<typename T>
void VectorMotion<T>::gripMoves(Sums &sums, std::uint32_t begin, std::uint32_t end, double dt)
{
   for (; begin < end; begin += kChunk) {
      const std::uint32_t count = std::min(end - begin, kChunk);
      std::uint8_t touches[kChunk];
      if (!findTouching(begin, count, touches, false))
         continue;
      for (std::uint32_t i = 0; i < count; ++i) {
         const std::int64_t cell = touches[i] ? m_layout.cell[begin + i] : -1;
         if (cell < 0)
            continue;
         driftContact(m_assembly->ground, touchAt(begin + i, cell, column(7)), dt, sums);
         m_gripping[begin + i] = grips(cell);
      }
   }
}

template void VectorMotion<float>::visitBefore(Visit &, std::uint32_t, std::uint32_t, float *, const float *,
                                               std::size_t);
template void VectorMotion<double>::visitBefore(Visit &, std::uint32_t, std::uint32_t, double *,
                                                const double *, std::size_t);
template void VectorMotion<float>::visitDriven(Visit &, std::uint32_t, const float *, const float *,
                                               std::size_t);
template void VectorMotion<double>::visitDriven(Visit &, std::uint32_t, const double *, const double *,
                                                std::size_t);
template void VectorMotion<float>::gripMoves(Sums &, std::uint32_t, std::uint32_t, double);
template void VectorMotion<double>::gripMoves(Sums &, std::uint32_t, std::uint32_t, double);

} // namespace bonds
