// How cells turn and drift, cubes and boxes, and what holds them. Included once per instruction set.
#if defined(BONDS_TURNS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BONDS_TURNS_INL_H
#undef BONDS_TURNS_INL_H
#else
#define BONDS_TURNS_INL_H
#endif

#include "explicit/lanes-inl.h"

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace bonds::HWY_NAMESPACE {

/// The turn by a rotation vector of any length, one cell at a time.
template<typename T>
HWY_NOINLINE void turnFar(T *q, const T *v)
{
   double x = v[0], y = v[1], z = v[2], hh = 0.25 * (x * x + y * y + z * z);
   if (hh > 1e6) { // a motion that diverges
      const double h = std::sqrt(hh), f = std::sin(h) / (2 * h);
      q[0] = static_cast<T>(std::cos(h));
      q[1] = static_cast<T>(f * x);
      q[2] = static_cast<T>(f * y);
      q[3] = static_cast<T>(f * z);
      return;
   }
   int halvings = 0;
   for (; hh >= 0.01 && halvings < 20; ++halvings) {
      hh *= 0.25;
      x *= 0.5;
      y *= 0.5;
      z *= 0.5;
   }
   double c = 1 - hh / 2 * (1 - hh / 12 * (1 - hh / 30 * (1 - hh / 56 * (1 - hh / 90))));
   const double s = 0.5 * (1 - hh / 6 * (1 - hh / 20 * (1 - hh / 42 * (1 - hh / 72 * (1 - hh / 110)))));
   x *= s;
   y *= s;
   z *= s;
   for (; halvings > 0; --halvings) { // the square of a unit quaternion
      const double f = 2 * c;
      c = 2 * c * c - 1;
      x *= f;
      y *= f;
      z *= f;
   }
   q[0] = static_cast<T>(c);
   q[1] = static_cast<T>(x);
   q[2] = static_cast<T>(y);
   q[3] = static_cast<T>(z);
}

template<class V>
struct Turn
{
   V w, x, y, z;
};

template<bool kFused, class D, typename T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE Turn<V> exponential(D d, Three<V> v)
{
   const V hh = hn::Mul(setTo(d, 0.25), dot<kFused>(v, v));
   V c, s;
   if constexpr (sizeof(T) == 4) {
      c = polynomial<kFused>(d, hh, {1.0, -1.0 / 2, 1.0 / 24, -1.0 / 720});
      s = polynomial<kFused>(d, hh, {0.5, -0.5 / 6, 0.5 / 120, -0.5 / 5040});
   } else {
      c = polynomial<kFused>(d, hh, {1.0, -1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800});
      s = polynomial<kFused>(d, hh, {0.5, -0.5 / 6, 0.5 / 120, -0.5 / 5040, 0.5 / 362880, -0.5 / 39916800});
   }
   Turn<V> q{c, hn::Mul(s, v.x), hn::Mul(s, v.y), hn::Mul(s, v.z)};
   if (HWY_LIKELY(hn::AllTrue(d, hn::Lt(hh, setTo(d, 0.01)))))
      return q;
   HWY_ALIGN T lane[8][kBlock];
   const V all[8] = {q.w, q.x, q.y, q.z, v.x, v.y, v.z, hh};
   for (int k = 0; k < 8; ++k)
      hn::Store(all[k], d, lane[k]);
   for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
      if (lane[7][i] < T(0.01))
         continue;
      T turn[4];
      const T by[3] = {lane[4][i], lane[5][i], lane[6][i]};
      turnFar(turn, by);
      for (int k = 0; k < 4; ++k)
         lane[k][i] = turn[k];
   }
   return {hn::Load(d, lane[0]), hn::Load(d, lane[1]), hn::Load(d, lane[2]), hn::Load(d, lane[3])};
}

/// Whether a degree of freedom of the lanes' cells is held.
template<typename T>
HWY_INLINE bool anyHeld(const std::uint8_t *held, std::size_t lanes)
{
   std::uint8_t any = 0;
   for (std::size_t i = 0; i < lanes; ++i)
      any |= held[i];
   return any != 0;
}

template<class D, typename T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_NOINLINE void hold(D d, const std::uint8_t *held, Three<V> &move, Three<V> &turn)
{
   HWY_ALIGN T lane[6][kBlock];
   V *all[6] = {&move.x, &move.y, &move.z, &turn.x, &turn.y, &turn.z};
   for (int k = 0; k < 6; ++k) {
      hn::Store(*all[k], d, lane[k]);
      for (std::size_t i = 0; i < hn::Lanes(d); ++i)
         if (held[i] >> k & 1)
            lane[k][i] = 0;
      *all[k] = hn::Load(d, lane[k]);
   }
}

/// Inertia of cells that are no cubes, as they are turned: that of a ball, and more or less about an axis or
/// two.
template<bool kFused, class V>
struct Boxes
{
   struct About
   {
      Three<V> axis;
      V inertia, inverse; // beside those of the ball

      Three<V> add(V more, Three<V> v, Three<V> to) const
      {
         return mad<kFused>(hn::Mul(more, dot<kFused>(axis, v)), axis, to);
      }
   };
   V ball, inverse;
   About first, second;
   bool two;

   Three<V> momentum(Three<V> w) const
   {
      const Three<V> out = first.add(first.inertia, w, ball * w);
      return two ? second.add(second.inertia, w, out) : out;
   }
   Three<V> spin(Three<V> momentum) const
   {
      const Three<V> out = first.add(first.inverse, momentum, inverse * momentum);
      return two ? second.add(second.inverse, momentum, out) : out;
   }
};

template<bool kFused, class V>
HWY_INLINE Turn<V> product(Turn<V> a, Turn<V> b)
{
   const Three<V> av{a.x, a.y, a.z}, bv{b.x, b.y, b.z};
   const Three<V> v = mad<kFused>(a.w, bv, mad<kFused>(b.w, av, cross<kFused>(av, bv)));
   return {hn::Sub(hn::Mul(a.w, b.w), dot<kFused>(av, bv)), v.x, v.y, v.z};
}

/// A vector turned by a unit quaternion.
template<bool kFused, class V>
HWY_INLINE Three<V> turnedVector(Turn<V> q, Three<V> v)
{
   const Three<V> axis{q.x, q.y, q.z}, once = cross<kFused>(axis, v), twice = once + once;
   return mad<kFused>(q.w, twice, v + cross<kFused>(axis, twice));
}

template<bool kFused, class D, typename T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE Boxes<kFused, V> boxesOf(D d, const SweepWork<T> &work, std::size_t cell, Turn<V> turn)
{
   const std::size_t stride = work.stride;
   const auto column = [&](std::size_t k) HWY_ATTR { return hn::LoadU(d, work.boxes + cell + k * stride); };
   const auto axis = [&](std::size_t k) HWY_ATTR {
      return turnedVector<kFused>(turn, three(d, work.boxes + cell + k * stride, stride, kWorld));
   };
   Boxes<kFused, V> out;
   out.ball = column(kBall);
   out.inverse = column(kBall + 1);
   out.first = {axis(kFirstAxis), column(kFirstAxis + 3), column(kFirstAxis + 4)};
   out.two = work.twoAxes;
   if (out.two)
      out.second = {axis(kSecondAxis), column(kSecondAxis + 3), column(kSecondAxis + 4)};
   return out;
}

template<class D, typename T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE Turn<V> turnAt(D d, const T *q, std::size_t stride)
{
   return {hn::LoadU(d, q), hn::LoadU(d, q + stride), hn::LoadU(d, q + 2 * stride),
           hn::LoadU(d, q + 3 * stride)};
}

/// The turn that boxes' inertia sees: none where turns count to first order only.
template<class K, class D, typename T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE Turn<V> inertiaTurn(D d, const T *q, std::size_t stride)
{
   if constexpr (K::small)
      return {hn::Set(d, 1), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
   else
      return turnAt(d, q, stride);
}

/// Keeps the spin that is held.
template<class D, typename T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE Three<V> keptSpin(D d, const std::uint8_t *held, Three<V> before, Three<V> after)
{
   if (!anyHeld<T>(held, hn::Lanes(d)))
      return after;
   Three<V> none = before, change = after - before;
   hold(d, held, none, change);
   return before + change;
}

/// A turn by a rotation vector, at unit length again.
template<bool kFused, class D, class V = hn::Vec<D>>
HWY_INLINE Turn<V> turnedBy(D d, Three<V> v, Turn<V> q)
{
   const Turn<V> n = product<kFused>(exponential<kFused>(d, v), q);
   const Three<V> nv{n.x, n.y, n.z};
   const V f = nmad<kFused>(setTo(d, 0.5), mad<kFused>(n.w, n.w, dot<kFused>(nv, nv)), setTo(d, 1.5));
   return {hn::Mul(f, n.w), hn::Mul(f, n.x), hn::Mul(f, n.y), hn::Mul(f, n.z)};
}

/// Torque-free turn of boxes: the spin at the middle of the step from the constant angular momentum, second
/// order.
template<bool kFused, class D, typename T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_NOINLINE void turnBoxes(D d, const SweepWork<T> &work, std::size_t cell, Three<V> w, double dt)
{
   const std::size_t stride = work.stride;
   T *const at = work.state + cell;
   const Turn<V> q = turnAt(d, at + 3 * stride, stride);
   const Three<V> momentum = boxesOf<kFused>(d, work, cell, q).momentum(w);
   const Turn<V> half = product<kFused>(exponential<kFused>(d, setTo(d, 0.5 * dt) * w), q);
   w = keptSpin(d, work.held + cell, w, boxesOf<kFused>(d, work, cell, half).spin(momentum));
   const Turn<V> now = turnedBy<kFused>(d, setTo(d, dt) * w, q);
   hn::StoreU(now.w, d, at + 3 * stride);
   storeThree(d, Three<V>{now.x, now.y, now.z}, at + 4 * stride, stride);
   w = keptSpin(d, work.held + cell, w, boxesOf<kFused>(d, work, cell, now).spin(momentum));
   storeThree(d, w, at + 10 * stride, stride);
}

template<class K, class D, typename T = hn::TFromD<D>>
HWY_INLINE void driftCells(D d, const SweepWork<T> &work, std::size_t cell, Three<hn::Vec<D>> v,
                           Three<hn::Vec<D>> w, double dt)
{
   using V = hn::Vec<D>;
   T *const at = work.state + cell;
   const std::size_t stride = work.stride;
   const V step = setTo(d, dt);
   storeThree(d, mad<K::fused>(step, v, three(d, at, stride, kWorld)), at, stride);
   if constexpr (K::small) { // half the rotation vector
      const V half = setTo(d, 0.5 * dt);
      return storeThree(d, mad<K::fused>(half, w, three(d, at + 4 * stride, stride, kWorld)), at + 4 * stride,
                        stride);
   }
   if (HWY_UNLIKELY(work.boxes != nullptr))
      return turnBoxes<K::fused>(d, work, cell, w, dt);
   const Turn<V> q = turnedBy<K::fused>(d, step * w, turnAt(d, at + 3 * stride, stride));
   hn::StoreU(q.w, d, at + 3 * stride);
   storeThree(d, Three<V>{q.x, q.y, q.z}, at + 4 * stride, stride);
}

} // namespace bonds::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
