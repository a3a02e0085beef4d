// Forces of the bonds of a run, added to those of their cells. Included once per instruction set.
#if defined(BONDS_RUNS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BONDS_RUNS_INL_H
#undef BONDS_RUNS_INL_H
#else
#define BONDS_RUNS_INL_H
#endif

#include "explicit/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bonds::HWY_NAMESPACE {

/// Columns of two ends and of what acts on them; of bonds that are listed, copies.
template<typename T>
struct EndPlaces
{
   const T *a, *b; // first of thirteen columns
   const T *rateA, *rateB;
   T *outA, *outB;
   std::size_t stride, outStrideA, outStrideB;
};

template<class D, typename T, class V = hn::Vec<D>>
HWY_INLINE void addThree(D d, T *at, std::size_t stride, const std::size_t (&order)[3], Three<V> v)
{
   T *const x = at + order[0] * stride, *const y = at + order[1] * stride, *const z = at + order[2] * stride;
   hn::StoreU(hn::Add(hn::LoadU(d, x), v.x), d, x);
   hn::StoreU(hn::Add(hn::LoadU(d, y), v.y), d, y);
   hn::StoreU(hn::Add(hn::LoadU(d, z), v.z), d, z);
}
template<class D, typename T, class V = hn::Vec<D>>
HWY_INLINE void takeThree(D d, T *at, std::size_t stride, const std::size_t (&order)[3], Three<V> v)
{
   T *const x = at + order[0] * stride, *const y = at + order[1] * stride, *const z = at + order[2] * stride;
   hn::StoreU(hn::Sub(hn::LoadU(d, x), v.x), d, x);
   hn::StoreU(hn::Sub(hn::LoadU(d, y), v.y), d, y);
   hn::StoreU(hn::Sub(hn::LoadU(d, z), v.z), d, z);
}

inline constexpr std::size_t kOrder[4][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 1, 2}};

/// What the bonds of a run need beside the law: nothing, their frame, or whatever the run's flags say.
enum class Needs : std::uint8_t { nothing, frame, any };

inline Needs needsOf(const Run &run)
{
   if ((run.flags & (Run::coupled | Run::actuated)) != 0)
      return Needs::any;
   return run.axis == 3 ? Needs::frame : Needs::nothing;
}

/// Nothing of the lanes whose bonds are not there: what they hold may be no number.
template<class K, class D, class V>
HWY_INLINE void keepOnly(D d, unsigned there, BondOut<V> &out)
{
   const std::uint8_t bits[8] = {static_cast<std::uint8_t>(there), static_cast<std::uint8_t>(there >> 8)};
   const auto mask = hn::LoadMaskBits(d, bits);
   for (Three<V> *v : {&out.force, &out.atA, &out.atB})
      *v = {hn::IfThenElseZero(mask, v->x), hn::IfThenElseZero(mask, v->y), hn::IfThenElseZero(mask, v->z)};
   if constexpr (K::damped)
      out.power = hn::IfThenElseZero(mask, out.power);
}

template<class K, Needs kNeeds, class D, typename T = hn::TFromD<D>>
HWY_INLINE void bondsOfVector(D d, const SweepWork<T> &work, const Run &run, const EndPlaces<T> &ends,
                              std::size_t at, unsigned there, T *power)
{
   using V = hn::Vec<D>;
   constexpr bool kGeneral = kNeeds == Needs::any;
   const auto &order = kOrder[run.axis];
   const bool uniform = run.flags & Run::uniform;
   const bool askew = kNeeds == Needs::frame || (kGeneral && run.axis == 3);
   const T *pool = work.pool + run.constants;
   BondLaw<V> law;
   const auto constant = [&](std::size_t i) HWY_ATTR {
      return uniform ? hn::Set(d, pool[i]) : hn::LoadU(d, pool + i * kBlock + at);
   };
   law.length = constant(kLength);
   law.k = {constant(kAxial), constant(kAxial + 1), constant(kAxial + 2)};
   law.c = {constant(kTorsion), constant(kTorsion + 1), constant(kTorsion + 2)};
   if constexpr (K::damped) {
      law.d = {constant(kDamping), constant(kDamping + 1), constant(kDamping + 2)};
      law.e = {constant(kDamping + 3), constant(kDamping + 4), constant(kDamping + 5)};
   }
   Three<V> frame[3];
   if constexpr (kGeneral) {
      const V zero = hn::Zero(d);
      law.part[0] = law.part[1] = zero;
      if (run.flags & Run::coupled) {
         law.part[0] = constant(kCoupling);
         law.part[1] = constant(kCoupling + 1);
      }
      law.stretch = law.turn = {zero, zero, zero};
      if (run.flags & Run::actuated) {
         constexpr std::size_t own[3] = {0, 1, 2};
         law.stretch = three(d, work.rest + run.rest + at, kBlock, own);
         law.turn = three(d, work.rest + run.rest + 3 * kBlock + at, kBlock, own);
      }
   }
   if constexpr (kNeeds != Needs::nothing)
      if (askew)
         for (int i = 0; i < 3; ++i) {
            const T *row = work.frames + 9 * run.frame + 3 * i;
            frame[i] = {hn::Set(d, row[0]), hn::Set(d, row[1]), hn::Set(d, row[2])};
         }
   const auto inAxes = [&](Three<V> v) HWY_ATTR {
      if constexpr (kNeeds != Needs::nothing)
         return askew ? rotate<K::fused>(frame, v) : v;
      else
         return v;
   };
   const std::size_t stride = ends.stride;
   const T *a = ends.a + at, *b = ends.b + at;
   BondState<V> state;
   state.du = inAxes(three(d, b, stride, order) - three(d, a, stride, order));
   if constexpr (!K::small) {
      state.aw = hn::LoadU(d, a + 3 * stride);
      state.bw = hn::LoadU(d, b + 3 * stride);
   }
   state.a = inAxes(three(d, a + 4 * stride, stride, order));
   state.b = inAxes(three(d, b + 4 * stride, stride, order));
   if constexpr (K::damped) {
      const T *ra = ends.rateA + at, *rb = ends.rateB + at;
      state.dv = inAxes(three(d, rb, stride, order) - three(d, ra, stride, order));
      const Three<V> wa = three(d, ra + 3 * stride, stride, order),
                     wb = three(d, rb + 3 * stride, stride, order);
      state.dw = inAxes(wb - wa);
      state.sum = inAxes(wa + wb);
   }
   BondOut<V> out;
   if constexpr (K::small)
      out = smallLaw<K::damped, kGeneral, K::fused>(d, state, law);
   else
      out = bondLaw<K::damped, kGeneral, K::fused>(d, state, law);
   if constexpr (kNeeds != Needs::nothing)
      if (askew) {
         out.force = rotateBack<K::fused>(frame, out.force);
         out.atA = rotateBack<K::fused>(frame, out.atA);
         out.atB = rotateBack<K::fused>(frame, out.atB);
      }
   if (HWY_UNLIKELY(there != (2u << (hn::Lanes(d) - 1)) - 1))
      keepOnly<K>(d, there, out);
   addThree(d, ends.outA + at, ends.outStrideA, order, out.force);
   addThree(d, ends.outA + 3 * ends.outStrideA + at, ends.outStrideA, order, out.atA);
   takeThree(d, ends.outB + at, ends.outStrideB, order, out.force);
   takeThree(d, ends.outB + 3 * ends.outStrideB + at, ends.outStrideB, order, out.atB);
   if constexpr (K::damped)
      hn::StoreU(hn::Add(hn::LoadU(d, power + at), out.power), d, power + at);
}

/// Halves of a run without coupled or actuated bonds take the shorter law, whatever the length of vectors.
template<class K, Needs kNeeds, class D, typename T = hn::TFromD<D>>
HWY_INLINE void bondsOfRun(D d, const SweepWork<T> &work, const Run &run, const EndPlaces<T> &ends, T *power)
{
   const std::size_t lanes = hn::Lanes(d);
   for (std::size_t at = 0; at < kBlock; at += lanes) {
      const unsigned there = run.lanes >> at & ((2u << (lanes - 1)) - 1);
      if (there == 0)
         continue;
      if constexpr (kNeeds == Needs::any && 2 * hn::MaxLanes(d) <= kBlock)
         if (run.axis < 3 && (run.flags & (2 * at < kBlock ? Run::plainFirst : Run::plainSecond))) {
            bondsOfVector<K, Needs::nothing>(d, work, run, ends, at, there, power);
            continue;
         }
      bondsOfVector<K, kNeeds>(d, work, run, ends, at, there, power);
   }
}

/// Ascending places of a column that lie in a few vectors side by side: a vector of values is picked out of
/// those, and added back into them, without touching each by itself.
template<class D, typename T = hn::TFromD<D>, class V = hn::Vec<D>>
class Picked
{
public:
   /// Whether a vector holds a whole block; smaller ones gain nothing (measured: f64 with AVX-512).
   static constexpr bool kWorthWhile = hn::MaxLanes(D()) == kBlock;

   /// What is not `there` comes last, at the place of the last that is.
   static bool fits(const std::uint32_t *places) { return places[kBlock - 1] - places[0] < kMost * kBlock; }
   HWY_INLINE void take(const std::uint32_t *places, std::uint16_t there)
   {
      m_first = places[0];
      m_windows = (places[kBlock - 1] - m_first) / kBlock + 1;
      for (std::size_t w = 0; w < m_windows; ++w)
         hn::Store(hn::Set(DU(), kNone), DU(), m_from + w * kBlock);
      for (std::size_t i = 0; i < kBlock; ++i) {
         m_to[i] = places[i] - m_first;
         if (there >> i & 1)
            m_from[m_to[i]] = static_cast<U>(i);
      }
   }
   HWY_INLINE V pick(D d, const T *column) const
   {
      const auto to = hn::Load(DU(), m_to);
      const auto indices = hn::IndicesFromVec(d, hn::And(to, hn::Set(DU(), U(kBlock - 1))));
      V out = hn::TableLookupLanes(hn::LoadU(d, column + m_first), indices);
      for (std::size_t at = kBlock; at < m_windows * kBlock; at += kBlock) {
         const auto later = hn::Gt(hn::BitCast(DI(), to), hn::Set(DI(), static_cast<I>(at - 1)));
         out = hn::IfThenElse(hn::RebindMask(d, later),
                              hn::TableLookupLanes(hn::LoadU(d, column + m_first + at), indices), out);
      }
      return out;
   }
   /// `column` begins with place `start`.
   HWY_INLINE void add(D d, T *column, std::size_t start, V values) const
   {
      for (std::size_t at = 0; at < m_windows * kBlock; at += kBlock) {
         T *const to = column + (m_first - start) + at;
         const auto from = hn::Load(DU(), m_from + at);
         const auto mask = hn::RebindMask(d, hn::Ne(from, hn::Set(DU(), kNone)));
         const auto indices = hn::IndicesFromVec(d, hn::And(from, hn::Set(DU(), U(kBlock - 1))));
         const V change = hn::IfThenElseZero(mask, hn::TableLookupLanes(values, indices));
         hn::StoreU(hn::Add(hn::LoadU(d, to), change), d, to);
      }
   }

private:
   using DU = hn::RebindToUnsigned<D>;
   using DI = hn::RebindToSigned<D>;
   using U = hn::TFromD<DU>;
   using I = hn::TFromD<DI>;
   static constexpr std::size_t kMost = 6;
   static constexpr U kNone = static_cast<U>(-1);

   std::size_t m_first = 0, m_windows = 0;
   HWY_ALIGN U m_to[kBlock];           // of each lane, how far from the first place
   HWY_ALIGN U m_from[kMost * kBlock]; // of each place, the lane
};

/// The columns of an end of a listed run's bonds, side by side, kBlock apart. One number after another:
/// gathering instructions take longer (measured on Zen 5), and compilers choose them for a loop that they see
/// through.
template<class K, typename T>
HWY_INLINE void gather(const SweepWork<T> &work, const std::uint32_t *places, std::size_t count, T *in)
{
   for (std::size_t i = 0; i < count; ++i) {
      std::size_t place = places[i];
      asm("" : "+r"(place));
      const T *from = work.state + place;
      for (std::size_t k = 0; k < 7; ++k)
         in[k * kBlock + i] = from[k * work.stride];
      if constexpr (K::damped) {
         from = work.rate + place;
         for (std::size_t k = 0; k < 6; ++k)
            in[(7 + k) * kBlock + i] = from[k * work.stride];
      }
   }
}

/// A run whose cells lie anywhere: copied together, and its forces spread in order.
template<class K, class D, typename T = hn::TFromD<D>>
HWY_NOINLINE void listedRun(D d, const SweepWork<T> &work, const Run &run, T *outA, std::size_t outStrideA,
                            T *outB, std::size_t outStrideB, std::uint32_t firstA, std::uint32_t firstB,
                            bool apart, T *power)
{
   HWY_ALIGN T in[2][13 * kBlock];
   HWY_ALIGN T out[2][6 * kBlock] = {};
   const std::uint32_t *lo = work.listLo + run.lo, *hi = work.listHi + run.lo;
   const std::size_t count = hwy::PopCount(run.lanes); // the first ones are there
   Picked<D> pickedLo, pickedHi;
   bool near = false;
   if constexpr (Picked<D>::kWorthWhile) {
      near = !apart && (run.flags & Run::ascending) && Picked<D>::fits(lo) && Picked<D>::fits(hi);
      if (near) {
         pickedLo.take(lo, run.lanes);
         pickedHi.take(hi, run.lanes);
         for (int k = 0; k < (K::damped ? 13 : 7); ++k) {
            const T *column = k < 7 ? work.state + k * work.stride : work.rate + (k - 7) * work.stride;
            hn::Store(pickedLo.pick(d, column), d, in[0] + k * kBlock);
            hn::Store(pickedHi.pick(d, column), d, in[1] + k * kBlock);
         }
      }
   }
   if (!near) {
      const std::size_t whole = hwy::RoundUpTo(count, hn::Lanes(d));
      gather<K>(work, lo, whole, in[0]);
      gather<K>(work, hi, whole, in[1]);
   }
   EndPlaces<T> ends{in[0],  in[1], in[0] + 7 * kBlock, in[1] + 7 * kBlock, out[0], out[1], kBlock,
                     kBlock, kBlock};
   if (apart) { // each bond has places of its own
      ends.outA = outA;
      ends.outB = outB;
      ends.outStrideA = outStrideA;
      ends.outStrideB = outStrideB;
   }
   switch (needsOf(run)) {
   case Needs::nothing:
      bondsOfRun<K, Needs::nothing>(d, work, run, ends, power);
      break;
   case Needs::frame:
      bondsOfRun<K, Needs::frame>(d, work, run, ends, power);
      break;
   case Needs::any:
      bondsOfRun<K, Needs::any>(d, work, run, ends, power);
      break;
   }
   if (apart)
      return;
   if constexpr (Picked<D>::kWorthWhile)
      if (near) {
         for (int k = 0; k < 6; ++k) {
            pickedLo.add(d, outA + k * outStrideA, firstA, hn::Load(d, out[0] + k * kBlock));
            pickedHi.add(d, outB + k * outStrideB, firstB, hn::Load(d, out[1] + k * kBlock));
         }
         return;
      }
   for (int k = 0; k < 6; ++k)
      for (std::size_t i = 0; i < count; ++i) {
         outA[k * outStrideA + lo[i] - firstA] += out[0][k * kBlock + i];
         outB[k * outStrideB + hi[i] - firstB] += out[1][k * kBlock + i];
      }
}

template<class K, Needs kNeeds, class D, typename T = hn::TFromD<D>>
HWY_NOINLINE void otherRun(D d, const SweepWork<T> &work, const Run &run, const EndPlaces<T> &ends, T *power)
{
   bondsOfRun<K, kNeeds>(d, work, run, ends, power);
}

/// Adds the forces of a run: at lo from `outA`, which stands for cell firstA, at hi likewise.
template<class K, class D, typename T = hn::TFromD<D>>
HWY_INLINE void addRun(D d, const SweepWork<T> &work, const Run &run, T *outA, std::size_t outStrideA,
                       T *outB, std::size_t outStrideB, std::uint32_t firstA, std::uint32_t firstB, T *power)
{
   if (HWY_UNLIKELY(run.flags & Run::listed))
      return listedRun<K>(d, work, run, outA, outStrideA, outB, outStrideB, firstA, firstB, false, power);
   const EndPlaces<T> ends{work.state + run.lo,
                           work.state + run.hi,
                           work.rate + run.lo,
                           work.rate + run.hi,
                           outA + (run.lo - firstA),
                           outB + (run.hi - firstB),
                           work.stride,
                           outStrideA,
                           outStrideB};
   const Needs needs = needsOf(run);
   if (HWY_LIKELY(needs == Needs::nothing))
      bondsOfRun<K, Needs::nothing>(d, work, run, ends, power);
   else if (needs == Needs::frame)
      otherRun<K, Needs::frame>(d, work, run, ends, power);
   else
      otherRun<K, Needs::any>(d, work, run, ends, power);
}

} // namespace bonds::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
