// The bond law of model/bond_kernel.h for as many bonds at once as a vector holds. Strains are formed from
// displacements since rest, so that single precision stays honest far from the origin. Included once per
// instruction set.
#if defined(BONDS_BOND_LAW_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BONDS_BOND_LAW_INL_H
#undef BONDS_BOND_LAW_INL_H
#else
#define BONDS_BOND_LAW_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bonds::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// a * b + c and c - a * b, with one rounding or two.
template<bool kFused, class V>
HWY_INLINE V mad(V a, V b, V c)
{
   if constexpr (kFused)
      return hn::MulAdd(a, b, c);
   else
      return hn::Add(hn::Mul(a, b), c);
}
template<bool kFused, class V>
HWY_INLINE V nmad(V a, V b, V c)
{
   if constexpr (kFused)
      return hn::NegMulAdd(a, b, c);
   else
      return hn::Sub(c, hn::Mul(a, b));
}

/// What a kernel is made for: dampers, turns that count to first order only, multiplying and adding with one
/// rounding.
template<bool kDamped, bool kSmall, bool kFused>
struct Kind
{
   static constexpr bool damped = kDamped, small = kSmall, fused = kFused;
};

template<class V>
struct Three
{
   V x, y, z;
};

template<class V>
HWY_INLINE Three<V> operator+(Three<V> a, Three<V> b)
{
   return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template<class V>
HWY_INLINE Three<V> operator-(Three<V> a, Three<V> b)
{
   return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template<class V>
HWY_INLINE Three<V> operator*(V s, Three<V> a)
{
   return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
template<bool kFused, class V>
HWY_INLINE Three<V> mad(V s, Three<V> a, Three<V> b)
{
   return {mad<kFused>(s, a.x, b.x), mad<kFused>(s, a.y, b.y), mad<kFused>(s, a.z, b.z)};
}
template<bool kFused, class V>
HWY_INLINE Three<V> nmad(V s, Three<V> a, Three<V> b)
{
   return {nmad<kFused>(s, a.x, b.x), nmad<kFused>(s, a.y, b.y), nmad<kFused>(s, a.z, b.z)};
}
template<bool kFused, class V>
HWY_INLINE V dot(Three<V> a, Three<V> b)
{
   return mad<kFused>(a.z, b.z, mad<kFused>(a.y, b.y, hn::Mul(a.x, b.x)));
}
template<bool kFused, class V>
HWY_INLINE Three<V> cross(Three<V> a, Three<V> b)
{
   return {nmad<kFused>(a.z, b.y, hn::Mul(a.y, b.z)), nmad<kFused>(a.x, b.z, hn::Mul(a.z, b.x)),
           nmad<kFused>(a.y, b.x, hn::Mul(a.x, b.y))};
}
/// Rows r of a matrix.
template<bool kFused, class V>
HWY_INLINE Three<V> rotate(const Three<V> (&r)[3], Three<V> a)
{
   return {dot<kFused>(r[0], a), dot<kFused>(r[1], a), dot<kFused>(r[2], a)};
}
template<bool kFused, class V>
HWY_INLINE Three<V> rotateBack(const Three<V> (&r)[3], Three<V> a)
{
   return mad<kFused>(a.z, r[2], mad<kFused>(a.y, r[1], a.x * r[0]));
}

/// sum of c[i] x^i
template<bool kFused, class D, class V, std::size_t kTerms>
HWY_INLINE V polynomial(D d, V x, const double (&c)[kTerms])
{
   V sum = hn::Set(d, static_cast<hn::TFromD<D>>(c[kTerms - 1]));
   for (std::size_t i = kTerms - 1; i-- > 0;)
      sum = mad<kFused>(sum, x, hn::Set(d, static_cast<hn::TFromD<D>>(c[i])));
   return sum;
}

/// x / sin x and (1 - x / sin x) / sin^2 x, from the vector part's square nn = sin^2 x and inv = 1 / (1 + cos
/// x).
template<bool kFused, class D, class V>
HWY_INLINE void arcRatio(D d, V nn, V inv, V &s, V &p)
{
   const V one = hn::Set(d, 1), small = hn::Set(d, static_cast<hn::TFromD<D>>(0.01));
   if constexpr (sizeof(hn::TFromD<D>) == 4)
      p = polynomial<kFused>(d, nn, {-1.0 / 6, -3.0 / 40, -5.0 / 112, -35.0 / 1152});
   else
      p = polynomial<kFused>(
          d, nn,
          {-1.0 / 6, -3.0 / 40, -5.0 / 112, -35.0 / 1152, -63.0 / 2816, -231.0 / 13312, -143.0 / 10240});
   s = nmad<kFused>(nn, p, one);
   const auto series = hn::Lt(nn, small);
   if (HWY_LIKELY(hn::AllTrue(d, series)))
      return;
   // Tangents of x/2, x/4, x/8; the series of the arc tangent converges fast below 0.2.
   const V n = hn::Sqrt(nn);
   V t = hn::Mul(n, inv);
   for (int halving = 0; halving < 2; ++halving)
      t = hn::Div(t, hn::Add(one, hn::Sqrt(mad<kFused>(t, t, one))));
   const V arc = polynomial<kFused>(d, hn::Mul(t, t),
                                    {1.0, -1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13,
                                     -1.0 / 15, 1.0 / 17, -1.0 / 19, 1.0 / 21, -1.0 / 23});
   const V large = hn::Div(hn::Mul(hn::Mul(hn::Set(d, 8), t), arc), n);
   s = hn::IfThenElse(series, s, large);
   p = hn::IfThenElse(series, p, hn::Div(hn::Sub(one, large), nn));
}

/// Both ends of bonds, in bond axes.
template<class V>
struct BondState
{
   Three<V> du; // displacement of b minus that of a
   V aw, bw;
   Three<V> a, b;        // vector parts
   Three<V> dv, sum, dw; // relative velocity, sum and difference of spins; only damped
};

template<class V>
struct BondLaw
{
   V length;
   Three<V> k, c;
   V part[2]; // of the relative turn, BondConstants::turn
   Three<V> d, e;
   Three<V> stretch, turn; // actuated rest shape
};

/// Step of model/bond_kernel.h: the turn from the middle frame to that of a stepped beam.
template<class V>
struct SteppedFrame
{
   Three<V> a; // half the turn's vector
   V f, twice; // 1 / (1 + a.a)

   template<bool kFused>
   HWY_INLINE Three<V> change(const Three<V> &v) const
   {
      const Three<V> first = cross<kFused>(a, v);
      return twice * (first + cross<kFused>(a, first));
   }
   template<bool kFused>
   HWY_INLINE Three<V> changeBack(const Three<V> &v) const
   {
      const Three<V> first = cross<kFused>(a, v);
      return twice * (cross<kFused>(a, first) - first);
   }
};

template<class V>
HWY_INLINE Three<V> scaledTurn(const BondLaw<V> &k, const Three<V> &phi)
{
   return {hn::Xor(phi.x, phi.x), hn::Mul(k.part[1], phi.y), hn::Mul(k.part[0], phi.z)};
}

template<bool kFused, class D, class V>
HWY_INLINE SteppedFrame<V> stepOf(D d, const BondLaw<V> &k, const Three<V> &phi)
{
   const V one = hn::Set(d, 1), half = hn::Set(d, static_cast<hn::TFromD<D>>(0.5));
   SteppedFrame<V> step;
   step.a = half * scaledTurn(k, phi);
   step.f = hn::Div(one, hn::Add(one, dot<kFused>(step.a, step.a)));
   step.twice = hn::Add(step.f, step.f);
   return step;
}

template<class V>
struct BondOut
{
   Three<V> force;    // on a
   Three<V> atA, atB; // torque on a; torque on b with the opposite sign
   V power;
};

/// v x (length, 0, 0)
template<class V>
HWY_INLINE Three<V> crossArm(const Three<V> &v, V length)
{
   return {hn::Xor(length, length), hn::Mul(v.z, length), hn::Neg(hn::Mul(v.y, length))};
}

/// evaluateSmall() of model/bond_kernel.h.
template<bool kDamped, bool kGeneral, bool kFused, class D, class V>
HWY_INLINE BondOut<V> smallLaw(D d, const BondState<V> &in, const BondLaw<V> &k)
{
   const V half = hn::Set(d, static_cast<hn::TFromD<D>>(0.5)), length = k.length;
   Three<V> e = in.du - crossArm(in.a + in.b, length);
   Three<V> phi = in.b - in.a;
   phi = phi + phi;
   if constexpr (kGeneral) {
      phi = phi - k.turn;
      e = e + crossArm(scaledTurn(k, phi), length) - k.stretch;
   }
   BondOut<V> out;
   Three<V> force{hn::Mul(k.k.x, e.x), hn::Mul(k.k.y, e.y), hn::Mul(k.k.z, e.z)};
   Three<V> c{hn::Mul(k.c.x, phi.x), hn::Mul(k.c.y, phi.y), hn::Mul(k.c.z, phi.z)};
   if constexpr (kDamped) {
      Three<V> rate = in.dv - crossArm(half * in.sum, length);
      if constexpr (kGeneral)
         rate = rate + crossArm(scaledTurn(k, in.dw), length);
      const Three<V> fd{hn::Mul(k.d.x, rate.x), hn::Mul(k.d.y, rate.y), hn::Mul(k.d.z, rate.z)},
          cd{hn::Mul(k.e.x, in.dw.x), hn::Mul(k.e.y, in.dw.y), hn::Mul(k.e.z, in.dw.z)};
      out.power = hn::Add(dot<kFused>(fd, rate), dot<kFused>(cd, in.dw));
      force = force + fd;
      c = c + cd;
   }
   const Three<V> moment = crossArm(force, length);
   if constexpr (kGeneral)
      c = c - scaledTurn(k, moment);
   const Three<V> g = half * moment;
   out.force = force;
   out.atA = c - g;
   out.atB = c + g;
   return out;
}

template<bool kDamped, bool kGeneral, bool kFused, class D, class V>
HWY_INLINE BondOut<V> bondLaw(D d, BondState<V> in, const BondLaw<V> &k)
{
   const V one = hn::Set(d, 1), half = hn::Set(d, static_cast<hn::TFromD<D>>(0.5));
   // The shorter of the two relative turns.
   V w = mad<kFused>(in.aw, in.bw, dot<kFused>(in.a, in.b));
   const V sign = hn::And(w, hn::SignBit(d));
   w = hn::Xor(w, sign);
   in.bw = hn::Xor(in.bw, sign);
   in.b = {hn::Xor(in.b.x, sign), hn::Xor(in.b.y, sign), hn::Xor(in.b.z, sign)};
   const Three<V> v = mad<kFused>(in.aw, in.b, nmad<kFused>(in.bw, in.a, cross<kFused>(in.b, in.a)));
   const V inv = hn::Div(one, hn::Add(one, w));
   // Middle frame, from the sum of two unit quaternions, whose square is 2 (1 + w).
   const V mw = hn::Add(in.aw, in.bw);
   const Three<V> m = in.a + in.b, f = inv * m;
   const V xx = hn::Mul(f.x, m.x), yy = hn::Mul(f.y, m.y), zz = hn::Mul(f.z, m.z);
   const V wx = hn::Mul(f.x, mw), wy = hn::Mul(f.y, mw), wz = hn::Mul(f.z, mw);
   const V bent = hn::Add(yy, zz);
   const Three<V> r[3] = {
       {hn::Sub(one, bent), nmad<kFused>(f.z, mw, hn::Mul(f.x, m.y)), mad<kFused>(f.x, m.z, wy)},
       {mad<kFused>(f.x, m.y, wz), hn::Sub(one, hn::Add(xx, zz)), nmad<kFused>(f.x, mw, hn::Mul(f.y, m.z))},
       {nmad<kFused>(f.y, mw, hn::Mul(f.x, m.z)), mad<kFused>(f.y, m.z, wx), hn::Sub(one, hn::Add(xx, yy))}};
   // R^T (du + l e_x) - l e_x without taking 1 from the diagonal.
   Three<V> e = rotateBack<kFused>(r, in.du);
   e = {nmad<kFused>(k.length, bent, e.x), mad<kFused>(k.length, r[0].y, e.y),
        mad<kFused>(k.length, r[0].z, e.z)};
   Three<V> u{hn::Add(e.x, k.length), e.y, e.z};
   const Three<V> apart = u;
   V s, p;
   arcRatio<kFused>(d, dot<kFused>(v, v), inv, s, p);
   Three<V> phi = hn::Add(s, s) * v;
   const Three<V> quarter = inv * v; // tan(|phi|/4) n
   [[maybe_unused]] SteppedFrame<V> step;
   if constexpr (kGeneral) {
      phi = phi - k.turn;
      step = stepOf<kFused>(d, k, phi);
      const Three<V> change = step.template change<kFused>(u);
      u = u + change;
      e = e + change - k.stretch;
   }
   BondOut<V> out;
   Three<V> force{hn::Mul(k.k.x, e.x), hn::Mul(k.k.y, e.y), hn::Mul(k.k.z, e.z)};
   Three<V> c{hn::Mul(k.c.x, phi.x), hn::Mul(k.c.y, phi.y), hn::Mul(k.c.z, phi.z)};
   if constexpr (kDamped) {
      const Three<V> dw = rotateBack<kFused>(r, in.dw), sum = rotateBack<kFused>(r, in.sum);
      const Three<V> phiRate = mad<kFused>(hn::Mul(p, dot<kFused>(v, dw)), v, s * dw);
      const Three<V> mean = half * (sum - cross<kFused>(quarter, dw));
      Three<V> rate = rotateBack<kFused>(r, in.dv) + cross<kFused>(apart, mean);
      if constexpr (kGeneral) {
         const Three<V> turning = scaledTurn(k, phiRate);
         const Three<V> spin = step.f * (turning + cross<kFused>(step.a, turning));
         rate = rate + step.template change<kFused>(rate) + cross<kFused>(spin, u);
      }
      const Three<V> fd{hn::Mul(k.d.x, rate.x), hn::Mul(k.d.y, rate.y), hn::Mul(k.d.z, rate.z)},
          cd{hn::Mul(k.e.x, phiRate.x), hn::Mul(k.e.y, phiRate.y), hn::Mul(k.e.z, phiRate.z)};
      out.power = hn::Add(dot<kFused>(fd, rate), dot<kFused>(cd, phiRate));
      force = force + fd;
      c = c + cd;
   }
   if constexpr (kGeneral) {
      const Three<V> moment = cross<kFused>(u, force);
      c = c + scaledTurn(k, step.f * (moment - cross<kFused>(step.a, moment)));
      force = force + step.template changeBack<kFused>(force);
   }
   const Three<V> g = half * cross<kFused>(force, apart);
   Three<V> h = mad<kFused>(hn::Mul(p, dot<kFused>(v, c)), v, s * c);
   h = h - cross<kFused>(g, quarter);
   out.force = rotate<kFused>(r, force);
   out.atA = rotate<kFused>(r, h - g);
   out.atB = rotate<kFused>(r, h + g);
   return out;
}

} // namespace bonds::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
