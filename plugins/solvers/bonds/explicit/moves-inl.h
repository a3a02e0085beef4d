// What forces do to cells: kicks, drifts and stages. Included once per instruction
// set.
#if defined(BONDS_MOVES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BONDS_MOVES_INL_H
#undef BONDS_MOVES_INL_H
#else
#define BONDS_MOVES_INL_H
#endif

#include "explicit/turns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bonds::HWY_NAMESPACE {

/// Sums over lanes of a block, added up in one order whatever the vector's length.
template<typename T>
struct LaneSums
{
   HWY_ALIGN T power[kBlock]{}, drag[kBlock]{}, load[kBlock]{};
};

template<typename T>
HWY_INLINE double total(T (&lanes)[kBlock])
{
   double sum = 0;
   for (T &lane : lanes) {
      sum += static_cast<double>(lane);
      lane = 0;
   }
   return sum;
}

/// Moves columns on by their rates, or from their start by all of the step's.
template<class K, class D, typename T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE V staged(D d, const SweepWork<T> &work, const Move &move, std::size_t at, V rate)
{
   T *const start = work.start + at, *const sum = work.sum + at;
   const V now = hn::LoadU(d, work.state + at);
   const V from = move.first ? now : hn::LoadU(d, start);
   const V all = mad<K::fused>(setTo(d, move.weight), rate, move.first ? hn::Zero(d) : hn::LoadU(d, sum));
   if (move.first)
      hn::StoreU(from, d, start);
   if (move.last)
      return mad<K::fused>(setTo(d, move.drift), all, from);
   hn::StoreU(all, d, sum);
   return mad<K::fused>(setTo(d, move.next), rate, from);
}

template<class K, class D, typename T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_NOINLINE void stageCells(D d, const SweepWork<T> &work, std::size_t cell, const Move &move, Three<V> v,
                             Three<V> w, Three<V> acceleration, Three<V> turning)
{
   const std::size_t stride = work.stride;
   T *const at = work.state + cell;
   const auto three3 = [&](std::size_t column, Three<V> rate) HWY_ATTR {
      return Three<V>{staged<K>(d, work, move, cell + column * stride, rate.x),
                      staged<K>(d, work, move, cell + (column + 1) * stride, rate.y),
                      staged<K>(d, work, move, cell + (column + 2) * stride, rate.z)};
   };
   const V half = setTo(d, 0.5), qw = hn::LoadU(d, at + 3 * stride);
   const Three<V> q = three(d, at + 4 * stride, stride, kWorld);
   storeThree(d, three3(0, v), at, stride);
   if constexpr (K::small) {
      storeThree(d, three3(4, half * w), at + 4 * stride, stride);
   } else {
      const V rateW = hn::Neg(hn::Mul(half, dot<K::fused>(w, q)));
      const Three<V> rateQ = half * mad<K::fused>(qw, w, cross<K::fused>(w, q));
      const V nw = staged<K>(d, work, move, cell + 3 * stride, rateW);
      const Three<V> nq = three3(4, rateQ);
      const V f = hn::Div(setTo(d, 1), hn::Sqrt(mad<K::fused>(nw, nw, dot<K::fused>(nq, nq))));
      hn::StoreU(hn::Mul(f, nw), d, at + 3 * stride);
      storeThree(d, f * nq, at + 4 * stride, stride);
   }
   storeThree(d, three3(7, acceleration), at + 7 * stride, stride);
   storeThree(d, three3(10, turning), at + 10 * stride, stride);
}

template<class D, typename T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE V powerOf(D d, const T *load, std::size_t stride, Three<V> v, Three<V> w)
{
   const Three<V> f = three(d, load, stride, kWorld), m = three(d, load + 3 * stride, stride, kWorld);
   return hn::Add(dot<false>(f, v), dot<false>(m, w));
}

/// What the torque of bonds, loads and drag makes of the spin of boxes: its rate in a stage, otherwise its
/// change over the kick.
template<class K, class D, typename T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_NOINLINE Three<V> turningOfBoxes(D d, const SweepWork<T> &work, std::size_t cell, Three<V> w,
                                     Three<V> torque, const Move &move)
{
   const std::size_t stride = work.stride;
   const auto boxes =
       boxesOf<K::fused>(d, work, cell, inertiaTurn<K>(d, work.state + cell + 3 * stride, stride));
   if (work.loads)
      torque = torque + three(d, work.loads + cell + 3 * stride, stride, kWorld);
   if (work.drag != 0)
      torque =
          nmad<K::fused>(hn::Set(d, work.drag),
                         boxes.momentum(three(d, work.rate + cell + 3 * stride, stride, kWorld)), torque);
   const Three<V> momentum = boxes.momentum(w);
   if (move.stage)
      return boxes.spin(K::small ? torque : torque - cross<K::fused>(w, momentum));
   return setTo(d, 1 / move.kick) * (boxes.spin(mad<K::fused>(setTo(d, move.kick), torque, momentum)) - w);
}

/// Kicks, and drifts, the cells [at, at + lanes).
template<class K, class D, typename T = hn::TFromD<D>>
HWY_INLINE void moveCells(D d, const SweepWork<T> &work, std::size_t cell, const Move &move, const T *atLo,
                          const T *atHi, std::size_t hiStride, LaneSums<T> &sums, std::size_t lane)
{
   using V = hn::Vec<D>;
   T *const at = work.state + cell;
   const std::size_t stride = work.stride;
   Three<V> v = three(d, at + 7 * stride, stride, kWorld), w = three(d, at + 10 * stride, stride, kWorld);
   const Three<V> force = three(d, atLo, kChunk, kWorld) + three(d, atHi, hiStride, kWorld),
                  torque = three(d, atLo + 3 * kChunk, kChunk, kWorld) +
                           three(d, atHi + 3 * hiStride, hiStride, kWorld);
   const V im = hn::LoadU(d, work.inverseMass + cell), ii = hn::LoadU(d, work.inverseInertia + cell);
   Three<V> move3 = im * force, turn3 = ii * torque;
   if (work.loads) {
      const T *load = work.loads + cell;
      move3 = mad<K::fused>(im, three(d, load, stride, kWorld), move3);
      turn3 = mad<K::fused>(ii, three(d, load + 3 * stride, stride, kWorld), turn3);
   }
   move3 = move3 +
           Three<V>{hn::Set(d, work.gravity[0]), hn::Set(d, work.gravity[1]), hn::Set(d, work.gravity[2])};
   if (work.drag != 0) {
      const V drag = hn::Set(d, work.drag);
      const T *rate = work.rate + cell;
      const Three<V> rv = three(d, rate, stride, kWorld), rw = three(d, rate + 3 * stride, stride, kWorld);
      move3 = nmad<K::fused>(drag, rv, move3);
      turn3 = nmad<K::fused>(drag, rw, turn3);
      V turning = hn::Div(dot<K::fused>(rw, rw), ii);
      if (work.boxes)
         turning = dot<K::fused>(
             rw, boxesOf<K::fused>(d, work, cell, inertiaTurn<K>(d, at + 3 * stride, stride)).momentum(rw));
      const V power = hn::Add(hn::Div(dot<K::fused>(rv, rv), im), turning);
      hn::StoreU(mad<K::fused>(drag, power, hn::LoadU(d, sums.drag + lane)), d, sums.drag + lane);
   }
   if (HWY_UNLIKELY(work.boxes != nullptr))
      turn3 = turningOfBoxes<K>(d, work, cell, w, torque, move);
   if (HWY_UNLIKELY(anyHeld<T>(work.held + cell, hn::Lanes(d))))
      hold(d, work.held + cell, move3, turn3);
   if (HWY_UNLIKELY(move.stage)) {
      if (work.loads)
         hn::StoreU(hn::Add(hn::LoadU(d, sums.load + lane), powerOf(d, work.loads + cell, stride, v, w)), d,
                    sums.load + lane);
      return stageCells<K>(d, work, cell, move, v, w, move3, turn3);
   }
   const V kick = setTo(d, move.kick);
   v = mad<K::fused>(kick, move3, v);
   w = mad<K::fused>(kick, turn3, w);
   if (move.predict) {
      storeThree(d, v, work.rate + cell, stride);
      storeThree(d, w, work.rate + cell + 3 * stride, stride);
      return;
   }
   storeThree(d, v, at + 7 * stride, stride);
   storeThree(d, w, at + 10 * stride, stride);
   if (work.loads)
      hn::StoreU(hn::Add(hn::LoadU(d, sums.load + lane), powerOf(d, work.loads + cell, stride, v, w)), d,
                 sums.load + lane);
   if (move.drift > 0 && !work.afterKick)
      driftCells<K>(d, work, cell, v, w, move.drift);
}

} // namespace bonds::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
