#include "explicit/drive.h"

#include "equilibrium/balance.h"

namespace bonds {

namespace {

std::array<double, 6> sixOf(Vec3 a, Vec3 b) { return {a.x, a.y, a.z, b.x, b.y, b.z}; }

std::array<double, 6> momentumOf(const Assembly &assembly, const State &state, std::int64_t i)
{
   return sixOf(assembly.mass[i] * state.velocityOf(i),
                spinMomentum(assembly, i, state.turnOf(i), state.spinOf(i)));
}

} // namespace

Drive::Drive(const sdk::SceneView &scene, const Assembly &assembly)
{
   if (!scene.channel("driven", 2))
      return;
   m_supports = std::make_shared<Supports>(scene, assembly);
   std::vector<int> masks(static_cast<std::size_t>(assembly.cells), 0);
   for (const Driven &driven : m_supports->driven())
      masks[driven.cell] |= 1 << driven.freedom;
   for (std::int64_t i = 0; i < assembly.cells; ++i)
      if (masks[i] != 0)
         m_cells.push_back({i, masks[i]});
   m_before.resize(m_cells.size());
}

void Drive::place(double time, State &state)
{
   m_reached = m_supports->targets(time);
   std::vector<Vec3> turns(static_cast<std::size_t>(state.n));
   const auto &driven = m_supports->driven();
   for (std::size_t i = 0; i < driven.size(); ++i) {
      const Driven &one = driven[i];
      if (one.freedom < 3) {
         state.displacement(one.freedom)[one.cell] = m_reached[i];
         continue;
      }
      const Vec3 now = state.turnVectorOf(one.cell);
      const double angle[3] = {now.x, now.y, now.z};
      Vec3 &turn = turns[one.cell];
      (one.freedom == 3   ? turn.x
       : one.freedom == 4 ? turn.y
                          : turn.z) = m_reached[i] - angle[one.freedom - 3];
   }
   for (const Led &led : m_cells)
      if (led.mask >> 3)
         state.setTurnedOn(led.cell, state.turnOf(led.cell), turns[led.cell]);
}

void Drive::lead(const Assembly &assembly, double time, double dt, State &state)
{
   for (std::size_t i = 0; i < m_cells.size(); ++i) {
      const std::int64_t cell = m_cells[i].cell;
      m_before[i] = {sixOf(state.velocityOf(cell), state.spinOf(cell)), momentumOf(assembly, state, cell),
                     state.turnOf(cell)};
   }
   m_target = m_supports->targets(time + dt);
   const auto &driven = m_supports->driven();
   for (std::size_t i = 0; i < driven.size(); ++i)
      state.column(7 + driven[i].freedom)[driven[i].cell] = (m_target[i] - m_reached[i]) / dt;
}

double Drive::arrive(const Assembly &assembly, double dt, State &state)
{
   m_reached = m_target;
   const auto &driven = m_supports->driven();
   for (std::size_t i = 0; i < driven.size(); ++i)
      if (driven[i].freedom < 3)
         state.displacement(driven[i].freedom)[driven[i].cell] = m_reached[i];
   double work = 0;
   for (std::size_t i = 0; i < m_cells.size(); ++i) {
      const std::int64_t cell = m_cells[i].cell;
      if (assembly.fixed[cell] >> 3 == 7 && m_cells[i].mask >> 3 != 0) // no other turn than the curves'
         state.setTurnedOn(cell, m_before[i].turn, dt * state.spinOf(cell));
      const auto velocity = sixOf(state.velocityOf(cell), state.spinOf(cell)),
                 momentum = momentumOf(assembly, state, cell);
      for (std::size_t k = 0; k < 6; ++k)
         if (m_cells[i].mask >> k & 1)
            work += 0.5 * (m_before[i].velocity[k] + velocity[k]) * (momentum[k] - m_before[i].momentum[k]);
   }
   return work;
}

} // namespace bonds
