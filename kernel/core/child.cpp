#include "core/child.h"

#include <fmt/format.h>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

namespace diatom {

namespace {

#if defined(__SANITIZE_THREAD__)
constexpr bool kMayFork = false; // its runtime does not follow children of processes with threads
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
constexpr bool kMayFork = false;
#else
constexpr bool kMayFork = true;
#endif
#else
constexpr bool kMayFork = true;
#endif

constexpr char kWhole = '.'; // after the last byte: the child came to its end

[[noreturn]] void beChild(int out, const std::function<std::string()> &work)
{
   std::signal(SIGPIPE, SIG_DFL);
   std::string bytes = work() + kWhole;
   for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t put = write(out, bytes.data() + at, bytes.size() - at);
      if (put <= 0)
         break;
      at += static_cast<std::size_t>(put);
   }
   _exit(0); // nothing that the parent has begun is ended twice
}

/// Reads until the other end closes. What went wrong, or nothing.
Status readAll(int in, std::string &bytes, double seconds, const Job &job)
{
   const auto start = std::chrono::steady_clock::now();
   std::array<char, 1 << 16> part;
   for (;;) {
      if (job.cancelled())
         return Error{ErrorCode::cancelled, "it was cancelled"};
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > seconds)
         return Error{ErrorCode::timeLimit, fmt::format("it took longer than {:.0f} s", seconds)};
      pollfd wait{in, POLLIN, 0};
      if (poll(&wait, 1, 50) <= 0)
         continue;
      const ssize_t got = read(in, part.data(), part.size());
      if (got < 0 && errno == EINTR)
         continue;
      if (got <= 0)
         return {};
      bytes.append(part.data(), static_cast<std::size_t>(got));
   }
}

} // namespace

Result<std::string> runInChild(const std::function<std::string()> &work, double seconds, const Job &job)
{
   std::array<int, 2> ends{};
   if (!kMayFork || pipe(ends.data()) != 0)
      return work();
   const pid_t child = fork();
   if (child == 0) {
      close(ends[0]);
      beChild(ends[1], work);
   }
   close(ends[1]);
   if (child < 0) {
      close(ends[0]);
      return work();
   }
   std::string bytes;
   const Status read = readAll(ends[0], bytes, seconds, job);
   close(ends[0]);
   if (!read)
      kill(child, SIGKILL);
   int status = 0;
   while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
   }
   if (!read)
      return read.error();
   if (WIFSIGNALED(status))
      return Error{ErrorCode::internal, fmt::format("it ended in a crash ({})", strsignal(WTERMSIG(status)))};
   if (bytes.empty() || bytes.back() != kWhole)
      return Error{ErrorCode::internal, "it ended before it was done"};
   bytes.pop_back();
   return bytes;
}

} // namespace diatom
