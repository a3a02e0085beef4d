#include "core/child.h"

#include "core/clock.h"
#include "core/sanitizers.h"

#include <fmt/format.h>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>

namespace diatom {

namespace {

// What goes through the pipe: a byte 0 to 100 for each percent that is done, kResult, the bytes, kWhole.
constexpr unsigned char kResult = 0xff;
constexpr char kWhole = '.';

bool writeAll(int out, std::string_view bytes)
{
   while (!bytes.empty()) {
      const ssize_t put = write(out, bytes.data(), bytes.size());
      if (put <= 0)
         return false;
      bytes.remove_prefix(static_cast<std::size_t>(put));
   }
   return true;
}

[[noreturn]] void beChild(int out, const std::function<std::string(const ChildProgress &)> &work)
{
   std::signal(SIGPIPE, SIG_DFL);
   int told = 0;
   const std::string bytes = work([&](double fraction) {
      const int percent = fraction > 0 ? static_cast<int>(100 * std::min(fraction, 1.0)) : 0;
      if (percent > told) {
         told = percent;
         const char byte = static_cast<char>(percent);
         writeAll(out, {&byte, 1});
      }
   });
   const char result = static_cast<char>(kResult);
   if (writeAll(out, {&result, 1}) && writeAll(out, bytes))
      writeAll(out, {&kWhole, 1});
   _exit(0); // nothing that the parent has begun is ended twice
}

/// What comes through the pipe, told or kept.
class Receiver
{
public:
   Receiver(std::string_view what, const Job &job) : m_what(what), m_job(job) {}

   void take(std::string_view bytes)
   {
      for (; !m_begun && !bytes.empty(); bytes.remove_prefix(1)) {
         const auto byte = static_cast<unsigned char>(bytes.front());
         m_begun = byte == kResult;
         if (!m_begun)
            m_job.progress(byte / 100.0, m_what);
      }
      m_bytes.append(bytes);
   }
   /// The bytes, when all have come.
   std::optional<std::string> result()
   {
      if (m_bytes.empty() || m_bytes.back() != kWhole)
         return std::nullopt;
      m_bytes.pop_back();
      return std::move(m_bytes);
   }

private:
   std::string_view m_what;
   const Job &m_job;
   bool m_begun = false;
   std::string m_bytes;
};

/// Reads until the other end closes. What went wrong, or nothing.
Status readAll(int in, Receiver &receiver, double seconds, const Job &job)
{
   const auto start = Clock::now();
   std::array<char, 1 << 16> part;
   for (;;) {
      if (job.cancelled())
         return Error{ErrorCode::cancelled, "it was cancelled"};
      if (secondsSince(start) > seconds)
         return Error{ErrorCode::timeLimit, fmt::format("it took longer than {:.0f} s", seconds)};
      pollfd wait{in, POLLIN, 0};
      if (poll(&wait, 1, 50) <= 0)
         continue;
      const ssize_t got = read(in, part.data(), part.size());
      if (got < 0 && errno == EINTR)
         continue;
      if (got <= 0)
         return {};
      receiver.take({part.data(), static_cast<std::size_t>(got)});
   }
}

} // namespace

Result<std::string> runInChild(const std::function<std::string(const ChildProgress &)> &work, double seconds,
                               std::string_view what, const Job &job)
{
   const auto inPlace = [&] { return work([&](double fraction) { job.progress(fraction, what); }); };
   job.progress(0, what);
   std::array<int, 2> ends{};
   if (!kMayFork || pipe(ends.data()) != 0)
      return inPlace();
   const pid_t child = fork();
   if (child == 0) {
      close(ends[0]);
      beChild(ends[1], work);
   }
   close(ends[1]);
   if (child < 0) {
      close(ends[0]);
      return inPlace();
   }
   Receiver receiver(what, job);
   const Status read = readAll(ends[0], receiver, seconds, job);
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
   auto bytes = receiver.result();
   if (!bytes)
      return Error{ErrorCode::internal, "it ended before it was done"};
   return *std::move(bytes);
}

} // namespace diatom
