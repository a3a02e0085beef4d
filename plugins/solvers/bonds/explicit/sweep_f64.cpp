// The sweep in double precision, for every instruction set.
#include "explicit/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "explicit/sweep_f64.cpp"
#include <hwy/foreach_target.h>
// After it, in this order.
#include "explicit/sweep-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bonds::HWY_NAMESPACE {

SweepKernel<double> f64Kernel(const KernelChoice &choice) { return kernelOf<double>(choice); }

} // namespace bonds::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bonds {

HWY_EXPORT(f64Kernel);

template<>
SweepKernel<double> sweepKernel<double>(const KernelChoice &choice)
{
   const AllowedTargets allowed(choice.atMost);
   return HWY_DYNAMIC_DISPATCH(f64Kernel)(choice);
}

} // namespace bonds
#endif
