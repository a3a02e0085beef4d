// Long work: progress, cancel and the only sanctioned way to use several threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>

namespace diatom {

/// Handed to every operation that may take longer than a moment. cancel() may be called from any thread;
/// everything else belongs to the thread that runs the work. Results never depend on the number of threads.
class Job
{
public:
   using Progress = std::function<void(double fraction, std::string_view what)>;

   Job() = default;
   explicit Job(Progress progress) : m_progress(std::move(progress)) {}

   void cancel() { m_cancelled.store(true, std::memory_order_relaxed); }
   bool cancelled() const { return m_cancelled.load(std::memory_order_relaxed); }
   /// Fraction 0 to 1. Called from the working thread; the callback decides how often to show it.
   void progress(double fraction, std::string_view what) const
   {
      if (m_progress)
         m_progress(fraction, what);
   }

   /// Threads parallelFor may use; 0 = as many as the machine has.
   void setThreads(int threads) { m_threads = threads; }
   int threads() const { return m_threads; }

   /// Runs body(begin, end) over [0, count) in pieces of `grain`. The split depends on `grain` only. A nested
   /// call runs in place. Bodies must write to disjoint places; sums are made per piece and added in order by
   /// the caller.
   void parallelFor(std::int64_t count, std::int64_t grain,
                    const std::function<void(std::int64_t begin, std::int64_t end)> &body) const;

private:
   Progress m_progress;
   std::atomic<bool> m_cancelled{false};
   int m_threads = 0;
};

} // namespace diatom
