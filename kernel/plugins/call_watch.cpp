#include "plugins/call_watch.h"

#include "plugins/warnings.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <list>
#include <mutex>
#include <optional>
#include <thread>

namespace diatom {

namespace {

using WatchClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{200};

struct WatchedCall
{
   const std::string *who;
   const char *function;
   const Job *job;
   std::optional<WatchClock::time_point> cancelled; // seen to be
   bool told = false;
};

/// One thread for all calls, begun with the first; it sleeps while there are none.
class Watcher
{
public:
   WatchedCall *add(const std::string &who, const char *function, const Job &job)
   {
      if (stopped)
         return nullptr;
      const std::lock_guard lock(m_mutex);
      m_calls.push_back({&who, function, &job, {}, false});
      if (!m_started) {
         m_started = true;
         std::thread([this] { watch(); }).detach();
      } else if (m_asleep) {
         m_wake.notify_one();
      }
      return &m_calls.back();
   }

   void remove(const WatchedCall *call)
   {
      if (!call)
         return;
      const std::lock_guard lock(m_mutex);
      m_calls.remove_if([&](const WatchedCall &one) { return &one == call; });
   }

   std::atomic<double> patience{10};
   std::atomic<bool> stopped{false};

private:
   void watch()
   {
      std::unique_lock lock(m_mutex);
      for (int idle = 0;; idle = m_calls.empty() ? idle + 1 : 0) {
         constexpr int kRest = 25; // looks without a call before it sleeps
         if (idle > kRest) {
            m_asleep = true;
            m_wake.wait(lock, [&] { return !m_calls.empty(); });
            m_asleep = false;
         }
         lock.unlock();
         std::this_thread::sleep_for(kLook);
         lock.lock();
         for (WatchedCall &call : m_calls)
            look(call);
      }
   }

   void look(WatchedCall &call) const
   {
      if (call.told || !call.job->cancelled())
         return;
      const auto now = WatchClock::now();
      if (!call.cancelled)
         call.cancelled = now;
      if (std::chrono::duration<double>(now - *call.cancelled).count() < patience)
         return;
      call.told = true;
      warnOfPlugin(
          fmt::format("{} ({}) has not answered to cancel for {:g} s; wait for it, or save your work "
                      "elsewhere and quit",
                      *call.who, call.function, patience.load()));
   }

   std::mutex m_mutex;
   std::condition_variable m_wake;
   std::list<WatchedCall> m_calls;
   bool m_started = false, m_asleep = false;
};

Watcher &watcher()
{
   static auto *const only = new Watcher; // its thread runs to the very end
   return *only;
}

} // namespace

CallWatch::CallWatch(const std::string &who, const char *function, const Job &job)
    : m_entry(watcher().add(who, function, job))
{}

CallWatch::~CallWatch() { watcher().remove(static_cast<const WatchedCall *>(m_entry)); }

void setCancelPatience(double seconds) { watcher().patience = seconds; }
void stopWatchingCalls() { watcher().stopped = true; }

} // namespace diatom
