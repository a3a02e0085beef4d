// The inner loop. Bonds along one axis share their permutation of components, so that no bond looks up a
// frame.
#include "explicit/forces.h"

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace bonds {

#if defined(__SSE__)
// Flush to zero and denormals are zero (MXCSR bits 15 and 6).
FlushDenormals::FlushDenormals() : m_saved(_mm_getcsr()) { _mm_setcsr(m_saved | 0x8040u); }
FlushDenormals::~FlushDenormals() { _mm_setcsr(m_saved); }
#else
FlushDenormals::FlushDenormals() = default;
FlushDenormals::~FlushDenormals() = default;
#endif

namespace {

/// Columns of the state as bonds along one axis see them.
struct Turned
{
   Turned(const State &state, int axis)
   {
      for (int k = 0; k < 3; ++k) {
         const int world = (axis + k) % 3;
         u[k] = state.column(world);
         q[k] = state.column(4 + world);
         v[k] = state.column(7 + world);
         w[k] = state.column(10 + world);
      }
      scalar = state.column(3);
   }
   const double *u[3], *scalar, *q[3], *v[3], *w[3];
};

inline Vec3 at(const double *const (&column)[3], std::int64_t i)
{
   return {column[0][i], column[1][i], column[2][i]};
}

template<bool Damped>
inline Ends aligned(const Turned &s, std::int64_t a, std::int64_t b, double length)
{
   Ends ends;
   ends.length = length;
   ends.separation = at(s.u, b) - at(s.u, a);
   ends.separation.x += length;
   ends.qa = {s.scalar[a], s.q[0][a], s.q[1][a], s.q[2][a]};
   ends.qb = {s.scalar[b], s.q[0][b], s.q[1][b], s.q[2][b]};
   if constexpr (Damped) {
      ends.dv = at(s.v, b) - at(s.v, a);
      ends.wa = at(s.w, a);
      ends.wb = at(s.w, b);
   }
   return ends;
}

} // namespace

BondForcesPass::BondForcesPass(const Assembly &assembly, bool actuated)
    : m_assembly(&assembly), m_power(static_cast<std::size_t>((assembly.links + kGrain - 1) / kGrain))
{
   const bool damped = assembly.damped, coupled = assembly.coupled;
   m_range = assembly.law == Law::small    ? select<Law::small>(damped, actuated, coupled)
             : assembly.law == Law::simple ? select<Law::simple>(damped, actuated, coupled)
                                           : select<Law::exact>(damped, actuated, coupled);
   for (Column &column : m_out)
      column.resize(static_cast<std::size_t>(assembly.links));
}

template<Law kLaw>
BondForcesPass::Range BondForcesPass::select(bool damped, bool actuated, bool coupled)
{
   using Self = BondForcesPass;
   static constexpr Range kTable[8] = {
       &Self::range<false, false, false, kLaw>, &Self::range<false, false, true, kLaw>,
       &Self::range<false, true, false, kLaw>,  &Self::range<false, true, true, kLaw>,
       &Self::range<true, false, false, kLaw>,  &Self::range<true, false, true, kLaw>,
       &Self::range<true, true, false, kLaw>,   &Self::range<true, true, true, kLaw>};
   return kTable[4 * damped + 2 * actuated + coupled];
}

template<bool Damped, bool Actuated, bool Coupled, Law kLaw>
void BondForcesPass::range(const State &state, const RestShape &rest, std::int64_t begin, std::int64_t end,
                           double &power)
{
   const Assembly &assembly = *m_assembly;
   double sum = 0;
   for (int axis = 0; axis < 4; ++axis) {
      const std::int64_t from = std::max(begin, assembly.group[axis]),
                         to = std::min(end, assembly.group[axis + 1]);
      const Turned turned(state, axis % 3);
      double *out[9];
      for (int k = 0; k < 9; ++k)
         out[k] = m_out[k / 3 * 3 + (axis + k % 3) % 3].data();
      for (std::int64_t i = from; i < to; ++i) {
         const Ends ends = axis < 3
                               ? aligned<Damped>(turned, assembly.a[i], assembly.b[i], assembly.lengthOf(i))
                               : endsOf(assembly, state, i);
         Vec3 restD{assembly.lengthOf(i), 0, 0}, restPhi{};
         if constexpr (Actuated) {
            restD = rest.separation(i);
            restPhi = rest.turn(i);
         }
         BondForces f;
         evaluate<Damped, Coupled, kLaw>(ends, assembly.constants[i], restD, restPhi, f);
         if (axis == 3) {
            const Mat3 frame = assembly.frameOf(i);
            f.force = transposed(frame, f.force);
            f.torqueA = transposed(frame, f.torqueA);
            f.torqueB = transposed(frame, f.torqueB);
         }
         out[0][i] = f.force.x;
         out[1][i] = f.force.y;
         out[2][i] = f.force.z;
         out[3][i] = f.torqueA.x;
         out[4][i] = f.torqueA.y;
         out[5][i] = f.torqueA.z;
         out[6][i] = f.torqueB.x;
         out[7][i] = f.torqueB.y;
         out[8][i] = f.torqueB.z;
         if constexpr (Damped)
            sum += f.power;
      }
   }
   power = sum;
}

double BondForcesPass::run(const sdk::Call &call, const State &state, const RestShape &rest)
{
   inPieces(call, m_assembly->cells >= kCellsForThreads, m_assembly->links,
            [&](std::int64_t begin, std::int64_t end, std::int64_t piece) {
               (this->*m_range)(state, rest, begin, end, m_power[piece]);
            });
   double sum = 0;
   for (const double power : m_power)
      sum += power;
   return sum;
}

void BondForcesPass::gather(std::int64_t i, Vec3 &force, Vec3 &torque) const
{
   const Assembly &assembly = *m_assembly;
   for (std::int64_t e = assembly.first[i]; e < assembly.first[i + 1]; ++e) {
      const std::int64_t bond = assembly.bondsOf[e] / 2;
      const Vec3 f{m_out[0][bond], m_out[1][bond], m_out[2][bond]};
      if (assembly.bondsOf[e] & 1) {
         force = force - f;
         torque = torque + Vec3{m_out[6][bond], m_out[7][bond], m_out[8][bond]};
      } else {
         force = force + f;
         torque = torque + Vec3{m_out[3][bond], m_out[4][bond], m_out[5][bond]};
      }
   }
}

} // namespace bonds
