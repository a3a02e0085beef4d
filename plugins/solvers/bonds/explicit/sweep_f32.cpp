// The sweep in single precision, for every instruction set.
#include "explicit/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "explicit/sweep_f32.cpp"
#include <hwy/foreach_target.h>
// After it, in this order.
#include "explicit/sweep-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bonds::HWY_NAMESPACE {

SweepKernel<float> f32Kernel(const KernelChoice &choice) { return kernelOf<float>(choice); }

} // namespace bonds::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bonds {

HWY_EXPORT(f32Kernel);

template<>
SweepKernel<float> sweepKernel<float>(const KernelChoice &choice)
{
   const AllowedTargets allowed(choice.atMost);
   return HWY_DYNAMIC_DISPATCH(f32Kernel)(choice);
}

} // namespace bonds
#endif
