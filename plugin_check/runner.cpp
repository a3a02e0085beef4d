#include "plugin_check/runner.h"

#include "core/clock.h"
#include "plugins/call_watch.h"
#include "plugins/process_state.h"
#include "plugins/process_traces.h"
#include "plugins/warnings.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <mutex>
#include <thread>

namespace diatom::check {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kReport = 3;             // descriptor, in the process of a check
constexpr std::size_t kMostTold = 600; // bytes of what a plugin printed

/// What came of waiting for a process.
struct Ended
{
   bool hung = false;
   int status = 0;
   std::string report;
};

class Pipe
{
public:
   Pipe()
   {
      if (::pipe2(m_ends.data(), O_CLOEXEC) != 0)
         m_ends = {-1, -1};
   }
   ~Pipe()
   {
      closeEnd(0);
      closeEnd(1);
   }
   Pipe(const Pipe &) = delete;
   Pipe &operator=(const Pipe &) = delete;
   int end(std::size_t which) const { return m_ends[which]; }
   void closeEnd(std::size_t which)
   {
      if (m_ends[which] >= 0)
         ::close(m_ends[which]);
      m_ends[which] = -1;
   }

private:
   std::array<int, 2> m_ends{};
};

std::vector<std::string> wordsOf(const Check &check, const Request &request)
{
   std::vector<std::string> words{"/proc/self/exe", request.folder.string(),      "--in-process", check.name,
                                  "--seed",         std::to_string(request.seed), "--hand-over"};
   for (const fs::path &design : request.designs) {
      words.emplace_back("--design");
      words.push_back(design.string());
   }
   return words;
}

/// Starts this program for one check; what it prints goes into `output`. -1 when it cannot be started.
pid_t start(const Check &check, const Request &request, Pipe &report, int output)
{
   const std::vector<std::string> words = wordsOf(check, request);
   std::vector<char *> arguments;
   for (const std::string &word : words)
      arguments.push_back(const_cast<char *>(word.c_str()));
   arguments.push_back(nullptr);
   posix_spawn_file_actions_t actions;
   ::posix_spawn_file_actions_init(&actions);
   ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
   ::posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
   ::posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
   ::posix_spawn_file_actions_adddup2(&actions, report.end(1), kReport);
   pid_t process = -1;
   const int failed = ::posix_spawn(&process, "/proc/self/exe", &actions, nullptr, arguments.data(), environ);
   ::posix_spawn_file_actions_destroy(&actions);
   report.closeEnd(1);
   return failed == 0 ? process : -1;
}

Ended await(pid_t process, int report, double seconds)
{
   Ended ended;
   const auto begin = Clock::now();
   std::array<char, 4096> part;
   for (;;) {
      if (secondsSince(begin) > seconds) {
         ended.hung = true;
         ::kill(process, SIGKILL);
         break;
      }
      pollfd wait{report, POLLIN, 0};
      if (::poll(&wait, 1, 100) <= 0)
         continue;
      const ssize_t got = ::read(report, part.data(), part.size());
      if (got <= 0)
         break;
      ended.report.append(part.data(), static_cast<std::size_t>(got));
   }
   while (::waitpid(process, &ended.status, 0) < 0 && errno == EINTR) {
   }
   return ended;
}

/// The end of what was printed, in one line.
std::string printed(int output)
{
   const off_t size = ::lseek(output, 0, SEEK_END);
   const off_t told = std::min<off_t>(size, kMostTold);
   std::string text(static_cast<std::size_t>(std::max<off_t>(told, 0)), ' ');
   const ssize_t got = ::pread(output, text.data(), text.size(), size - told);
   text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
   while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())))
      text.pop_back();
   for (char &c : text)
      c = c == '\n' ? '|' : c;
   return text;
}

std::vector<Finding> readReport(const std::string &report)
{
   std::vector<Finding> findings;
   for (const Json &one : Json::parse(report))
      findings.push_back({static_cast<Severity>(one.at(0).get<int>()), one.at(1).get<std::string>()});
   return findings;
}

std::vector<Finding> findingsOf(const Ended &ended, int output, double seconds)
{
   const std::string text = printed(output);
   const std::string also = text.empty() ? "" : fmt::format("; it printed: {}", text);
   if (ended.hung)
      return {{Severity::failure, fmt::format("it did not end within {:.0f} s{}", seconds, also)}};
   if (WIFSIGNALED(ended.status))
      return {
          {Severity::failure, fmt::format("it crashed ({}){}", ::strsignal(WTERMSIG(ended.status)), also)}};
   if (!Json::accept(ended.report))
      return {{Severity::failure,
               fmt::format("it ended the process (exit code {}){}", WEXITSTATUS(ended.status), also)}};
   std::vector<Finding> findings = readReport(ended.report);
   if (!text.empty())
      findings.push_back(
          {Severity::failure, fmt::format("it prints, which belongs to the program alone: {}", text)});
   return findings;
}

} // namespace

std::vector<Finding> runHere(const Check &check, Subject subject)
{
   Findings findings;
   std::mutex mutex;
   setPluginWarnings([&](const std::string &sentence, PluginWarning kind) {
      if (kind == PluginWarning::remark)
         return;
      const std::lock_guard lock(mutex);
      findings.add(Severity::failure, sentence);
   });
   stopWatchingCalls(); // its thread is the host's, and hanging is told by the clock
   const int most = std::max(check.threads, static_cast<int>(std::thread::hardware_concurrency()));
   Job warm;
   warm.setThreads(most); // threads of the host's that stay are not the plugin's
   warm.parallelFor(most, 1, [](std::int64_t, std::int64_t) {});
   const ProcessTraces before;
   ProcessState process;
   if (!check.interface) {
      check.run(subject, findings);
   } else {
      for (const Provided &provided : subject.manifest.provides)
         if (provided.interface == check.interface) {
            findings.about(subject.manifest.provides.size() > 1 ? provided.id : "");
            subject.provided = &provided;
            check.run(subject, findings);
         }
   }
   findings.about("");
   std::string left = ProcessTraces().since(before);
   for (int i = 0; i < 20 && !left.empty(); ++i) { // a thread that has ended stays in sight for a moment
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      left = ProcessTraces().since(before);
   }
   if (!left.empty())
      findings.fail("it " + left + ", which a plugin must not do");
   if (const std::string changed = process.restore(); !changed.empty())
      findings.fail("it changed " + changed + ", which a plugin must not do");
   setPluginWarnings({});
   return findings.all();
}

Outcome runApart(const Check &check, const Request &request)
{
   Outcome outcome{&check, {}, 0};
   const auto begin = Clock::now();
   const int output = ::memfd_create("output", MFD_CLOEXEC);
   Pipe report;
   const pid_t process = output < 0 || report.end(0) < 0 ? -1 : start(check, request, report, output);
   if (process < 0)
      outcome.findings = {{Severity::failure, fmt::format("no process can be started for it ({}); it was not "
                                                          "checked",
                                                          std::strerror(errno))}};
   else
      outcome.findings = findingsOf(await(process, report.end(0), request.seconds), output, request.seconds);
   if (output >= 0)
      ::close(output);
   outcome.seconds = secondsSince(begin);
   return outcome;
}

void handOver(const std::vector<Finding> &findings)
{
   Json report = Json::array();
   for (const Finding &finding : findings)
      report.push_back({static_cast<int>(finding.severity), finding.text});
   const std::string text = report.dump(-1, ' ', false, Json::error_handler_t::replace);
   for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t put = ::write(kReport, text.data() + sent, text.size() - sent);
      if (put <= 0)
         return;
      sent += static_cast<std::size_t>(put);
   }
}

} // namespace diatom::check
