// Four passes, each over what it writes: stretches of bonds, stresses of cells, tensions of bonds, and the
// forces that a cell gets from its own bonds in their order. No sum depends on the number of threads.
#include "solid/cell_coupling.h"

#include <algorithm>

namespace bonds {

namespace {

constexpr std::int64_t kGrain = 2048;
constexpr std::int64_t kForThreads = 4096; // fewer lose more to waking threads than they gain

template<typename Body>
void overAll(const sdk::Call &call, std::int64_t count, Body body)
{
   if (count < kForThreads)
      body(std::int64_t{0}, count);
   else
      call.parallelFor(count, kGrain, body);
}

Vec3 times(const Symmetric &m, Vec3 e)
{
   return {m[0] * e.x + m[5] * e.y + m[4] * e.z, m[5] * e.x + m[1] * e.y + m[3] * e.z,
           m[4] * e.x + m[3] * e.y + m[2] * e.z};
}

/// Three columns of the state or of the room, along the axes of bonds along `axis`.
template<typename Value>
struct Turned
{
   Turned(Value *x, Value *y, Value *z, int axis)
   {
      Value *const world[3] = {x, y, z};
      for (int k = 0; k < 3; ++k)
         column[k] = world[(axis + k) % 3];
   }
   Vec3 at(std::int64_t i) const { return {column[0][i], column[1][i], column[2][i]}; }
   void set(std::int64_t i, Vec3 v) const
   {
      column[0][i] = v.x;
      column[1][i] = v.y;
      column[2][i] = v.z;
   }
   Value *column[3];
};

Turned<const double> columns(const State &state, int first, int axis)
{
   return {state.column(first), state.column(first + 1), state.column(first + 2), axis};
}

} // namespace

void CellCoupling::measure(const State &state, const RestShape *rest, std::int64_t begin,
                           std::int64_t end) const
{
   const Assembly &assembly = *m_assembly;
   for (int axis = 0; axis < 3; ++axis) {
      const auto number = [&](std::int64_t bond) {
         return std::lower_bound(m_bond.begin(), m_bond.end(), bond) - m_bond.begin();
      };
      const std::int64_t from = std::max<std::int64_t>(begin, number(assembly.group[axis])),
                         to = std::min<std::int64_t>(end, number(assembly.group[axis + 1]));
      const auto u = columns(state, 0, axis), q = columns(state, 4, axis), v = columns(state, 7, axis),
                 w = columns(state, 10, axis);
      const double *scalar = state.column(3);
      const auto out = [&](int first) {
         auto &g = m_room.gradient;
         return Turned<double>(g[first].data(), g[first + 1].data(), g[first + 2].data(), axis);
      };
      const auto along = out(0), turnA = out(3), turnB = out(6);
      for (std::int64_t n = from; n < to; ++n) {
         const std::int64_t bond = m_bond[n], a = assembly.a[bond], b = assembly.b[bond];
         const Vec3 qa = q.at(a), qb = q.at(b);
         const Stretch s = stretchOf({u.at(b) - u.at(a),
                                      assembly.lengthOf(bond),
                                      {scalar[a], qa.x, qa.y, qa.z},
                                      {scalar[b], qb.x, qb.y, qb.z},
                                      {},
                                      {},
                                      {}});
         m_room.stretch[n] = s.stretch - restOf(n, rest);
         along.set(n, s.along);
         turnA.set(n, s.turnA);
         turnB.set(n, s.turnB);
         if (m_damped)
            m_room.rate[n] = dot(s.along, v.at(b) - v.at(a)) + dot(s.turnA, w.at(a)) + dot(s.turnB, w.at(b));
      }
   }
}

void CellCoupling::strain(std::int64_t begin, std::int64_t end) const
{
   const auto put = [](std::array<Column, 3> &to, std::int64_t i, Vec3 v) {
      to[0][i] = v.x;
      to[1][i] = v.y;
      to[2][i] = v.z;
   };
   for (std::int64_t i = begin; i < end; ++i) {
      put(m_room.stress, i, times(m_stiffness[i], meanOf(i, m_room.stretch, &Weight::strain)));
      if (m_damped)
         put(m_room.loss, i, times(m_loss[i], meanOf(i, m_room.rate, &Weight::rate)));
   }
}

double CellCoupling::tensionOf(std::int64_t number, bool damped) const
{
   const int axis = axisOf(number);
   double sum = 0;
   for (const Slot slot : {2 * number, 2 * number + 1}) {
      const std::int64_t cell = m_number[cellAt(slot)];
      if (cell < 0)
         continue;
      const Weight &weight = m_weight[slot & 1][number];
      sum += weight.strain * m_room.stress[axis][cell];
      if (damped)
         sum += weight.rate * m_room.loss[axis][cell];
   }
   return sum;
}

void CellCoupling::gather(CellForces &forces, std::int64_t begin, std::int64_t end) const
{
   for (std::int64_t cell = begin; cell < end; ++cell) {
      double sum[6]{};
      for (std::int64_t s = m_first[cell]; s < m_first[cell + 1]; ++s) {
         const std::int64_t n = m_slot[s] / 2;
         const bool isB = m_slot[s] & 1;
         const double t = m_room.tension[n], pull = isB ? -t : t;
         const auto *turn = &m_room.gradient[isB ? 6 : 3];
         for (int k = 0; k < 3; ++k) {
            sum[k] += pull * m_room.gradient[k][n];
            sum[3 + k] -= t * turn[k][n];
         }
      }
      for (int k = 0; k < 6; ++k)
         forces[k][cell] += sum[k];
   }
}

double CellCoupling::power() const
{
   double sum = 0;
   for (std::size_t i = 0; i < m_cell.size(); ++i) {
      const auto number = static_cast<std::int64_t>(i);
      const Vec3 rate = meanOf(number, m_room.rate, &Weight::rate);
      sum += dot(rate, {m_room.loss[0][i], m_room.loss[1][i], m_room.loss[2][i]});
   }
   return sum;
}

double CellCoupling::addForces(const sdk::Call &call, const State &state, const RestShape *rest,
                               CellForces &forces) const
{
   const auto bonds = static_cast<std::int64_t>(m_bond.size()),
              cells = static_cast<std::int64_t>(m_cell.size());
   const auto pass = [&](std::int64_t count, auto body) { overAll(call, count, body); };
   pass(bonds, [&](std::int64_t begin, std::int64_t end) { measure(state, rest, begin, end); });
   pass(cells, [&](std::int64_t begin, std::int64_t end) { strain(begin, end); });
   pass(bonds, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t n = begin; n < end; ++n)
         m_room.tension[n] = tensionOf(n, m_damped);
   });
   pass(m_assembly->cells, [&](std::int64_t begin, std::int64_t end) { gather(forces, begin, end); });
   return m_damped ? power() : 0;
}

} // namespace bonds
