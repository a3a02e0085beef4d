#include "core/job.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <memory>

namespace diatom {

namespace {

/// Pieces that a thread takes first; others help when theirs are done. Alone on its line of the cache.
struct alignas(64) Share
{
   std::atomic<std::int64_t> next = 0;
   std::int64_t end = 0;
};

} // namespace

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
   // Each thread has its own share, the same in every loop over as many pieces: what it touched last lies in
   // its cache.
   const auto shares = std::make_unique<Share[]>(static_cast<std::size_t>(threads));
   for (int i = 0; i < threads; ++i) {
      shares[i].next = pieces * i / threads;
      shares[i].end = pieces * (i + 1) / threads;
   }
#pragma omp parallel num_threads(threads)
   for (int i = 0, own = omp_get_thread_num(); i < threads; ++i) {
      Share &share = shares[(own + i) % threads];
      for (std::int64_t piece = share.next++; piece < share.end; piece = share.next++)
         body(piece * grain, std::min((piece + 1) * grain, count));
   }
}

} // namespace diatom
