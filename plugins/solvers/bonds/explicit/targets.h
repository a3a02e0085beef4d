// Instruction sets that the vector kernel is built for, and how to do with fewer than the machine has.
#pragma once

// SSE4, AVX2 and AVX-512, or NEON: others are too like these to be worth their share of the build.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)

#include "model/assembly.h"

#include <hwy/targets.h>

#include <mutex>

namespace bonds {

/// Highway chooses among the targets allowed while this lives.
class AllowedTargets
{
public:
   explicit AllowedTargets(Options::Instructions atMost) : m_lock(mutex())
   {
      std::int64_t allowed = hwy::SupportedTargets();
      if (atMost != Options::Instructions::best)
         allowed &= ~(std::int64_t{HWY_AVX2} - 1); // better ones have lower bits
      if (atMost == Options::Instructions::sse4)
         allowed &= ~(std::int64_t{HWY_SSE4} - 1);
      hwy::GetChosenTarget().Update(allowed != 0 ? allowed : hwy::SupportedTargets());
   }
   ~AllowedTargets() { hwy::GetChosenTarget().DeInit(); }
   AllowedTargets(const AllowedTargets &) = delete;
   AllowedTargets &operator=(const AllowedTargets &) = delete;

private:
   static std::mutex &mutex()
   {
      static std::mutex one;
      return one;
   }
   std::scoped_lock<std::mutex> m_lock;
};

} // namespace bonds
