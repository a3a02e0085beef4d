// Vectors of the kernel and how they come from columns. Included once per instruction set.
#if defined(BONDS_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BONDS_LANES_INL_H
#undef BONDS_LANES_INL_H
#else
#define BONDS_LANES_INL_H
#endif

#include "explicit/bond_law-inl.h"
#include "explicit/sweep.h"

HWY_BEFORE_NAMESPACE();
namespace bonds::HWY_NAMESPACE {

template<typename T>
using Lanes = hn::CappedTag<T, kBlock>;

template<class D>
HWY_INLINE hn::Vec<D> setTo(D d, double value)
{
   return hn::Set(d, static_cast<hn::TFromD<D>>(value));
}

template<class D, typename T>
HWY_INLINE Three<hn::Vec<D>> three(D d, const T *at, std::size_t stride, const std::size_t (&order)[3])
{
   return {hn::LoadU(d, at + order[0] * stride), hn::LoadU(d, at + order[1] * stride),
           hn::LoadU(d, at + order[2] * stride)};
}

inline constexpr std::size_t kWorld[3] = {0, 1, 2};

template<class D, typename T, class V = hn::Vec<D>>
HWY_INLINE void storeThree(D d, Three<V> v, T *at, std::size_t stride)
{
   hn::StoreU(v.x, d, at);
   hn::StoreU(v.y, d, at + stride);
   hn::StoreU(v.z, d, at + 2 * stride);
}

} // namespace bonds::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
