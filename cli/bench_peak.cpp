// The most that one core multiplies and adds, in the widest vectors it has: what a kernel is held against.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cli/bench_peak.cpp"
#include <hwy/foreach_target.h>
// After it, in this order.
#include <hwy/highway.h>

#include "cli/bench.h"
#include "core/clock.h"

#include <algorithm>
#include <chrono>

HWY_BEFORE_NAMESPACE();
namespace diatom::cli::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template<typename T>
double measured()
{
   const hn::ScalableTag<T> d;
   using V = hn::Vec<decltype(d)>;
   constexpr int kSteps = 200000, kChains = 12; // two units of four steps' latency, and some to spare
   double best = 0;
   for (int turn = 0; turn < 20; ++turn) {
      const V factor = hn::Set(d, static_cast<T>(0.999)), term = hn::Set(d, static_cast<T>(0.5));
      V a = factor, b = term, c = factor, e = term, f = factor, g = term, h = factor, i = term, j = factor,
        k = term, l = factor, m = term;
      const auto start = Clock::now();
      for (int step = 0; step < kSteps; ++step) {
         a = hn::MulAdd(a, factor, term);
         b = hn::MulAdd(b, factor, term);
         c = hn::MulAdd(c, factor, term);
         e = hn::MulAdd(e, factor, term);
         f = hn::MulAdd(f, factor, term);
         g = hn::MulAdd(g, factor, term);
         h = hn::MulAdd(h, factor, term);
         i = hn::MulAdd(i, factor, term);
         j = hn::MulAdd(j, factor, term);
         k = hn::MulAdd(k, factor, term);
         l = hn::MulAdd(l, factor, term);
         m = hn::MulAdd(m, factor, term);
      }
      const double seconds = secondsSince(start);
      const V all =
          hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)),
                  hn::Add(hn::Add(hn::Add(f, g), hn::Add(h, i)), hn::Add(hn::Add(j, k), hn::Add(l, m))));
      const auto sum = static_cast<double>(hn::GetLane(hn::SumOfLanes(d, all)));
      if (sum > 0) // it is; this keeps the loop
         best = std::max(best, 2.0 * kChains * kSteps * static_cast<double>(hn::Lanes(d)) / seconds / 1e9);
   }
   return best;
}

double singlePeak() { return measured<float>(); }
double doublePeak() { return measured<double>(); }

} // namespace diatom::cli::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace diatom::cli {

HWY_EXPORT(singlePeak);
HWY_EXPORT(doublePeak);

double peakGflops(bool single)
{
   return single ? HWY_DYNAMIC_DISPATCH(singlePeak)() : HWY_DYNAMIC_DISPATCH(doublePeak)();
}

} // namespace diatom::cli
#endif
