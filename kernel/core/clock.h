// Time that passes, for measuring what work takes. Never decides what a simulation gives.
#pragma once

#include <chrono>

namespace diatom {

using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point start)
{
   return std::chrono::duration<double>(Clock::now() - start).count();
}

} // namespace diatom
