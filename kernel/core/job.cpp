#include "core/job.h"

#include <omp.h>

#include <algorithm>

namespace diatom {

void Job::parallelFor(std::int64_t count, std::int64_t grain,
                      const std::function<void(std::int64_t, std::int64_t)> &body) const
{
   grain = std::max<std::int64_t>(grain, 1);
   const std::int64_t pieces = (count + grain - 1) / grain;
   const int threads = m_threads > 0 ? m_threads : omp_get_max_threads();
   if (pieces <= 1 || threads <= 1 || omp_in_parallel()) {
      for (std::int64_t begin = 0; begin < count; begin += grain)
         body(begin, std::min(begin + grain, count));
      return;
   }
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
   for (std::int64_t piece = 0; piece < pieces; ++piece)
      body(piece * grain, std::min((piece + 1) * grain, count));
}

} // namespace diatom
