#include "plugins/worker_process.h"

#include "core/clock.h"
#include "plugins/instance.h"

#include <fmt/format.h>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>
#include <utility>

namespace diatom {

namespace {

constexpr int kGlance = 50;      // ms between looks at whether the user has cancelled
constexpr double kPatience = 10; // s that a cancelled solver has to stop
constexpr int kWorkersEnd = 3;   // descriptor of the line in the worker
constexpr const char *kProgram = "diatom-worker";

/// Beside the program, or in the bin folder beside its own.
std::filesystem::path workerProgram()
{
   std::error_code failed;
   const auto folder = std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
   for (const auto &candidate : {folder / kProgram, folder.parent_path() / "bin" / kProgram})
      if (::access(candidate.c_str(), X_OK) == 0)
         return candidate;
   return {};
}

/// What a message holds: the status of the call, or that of a damaged one.
std::int32_t taken(const diatom_call *call, std::string_view message, WorkerProcess::Answer &answer)
{
   std::string report;
   if (!takeRecord(message, answer.reply) || !takeText(message, report))
      return refuseCall(call, kWorkerDamaged);
   answer.texts.resize(static_cast<std::size_t>(std::clamp(answer.reply.texts, 0, 1 << 16)));
   for (std::string &one : answer.texts)
      if (!takeText(message, one))
         return refuseCall(call, kWorkerDamaged);
   if (!report.empty())
      call->report(call, answer.reply.status == DIATOM_OK ? DIATOM_WARNING : DIATOM_ERROR, report.c_str());
   return answer.reply.status;
}

} // namespace

std::int32_t refuseCall(const diatom_call *call, const std::string &why, std::int32_t status)
{
   call->report(call, DIATOM_ERROR, why.c_str());
   return status;
}

WorkerProcess::WorkerProcess(Line line, SharedMemory control, pid_t process)
    : m_line(std::move(line)), m_control(std::move(control)), m_process(process)
{}

WorkerControl &WorkerProcess::control() const { return *reinterpret_cast<WorkerControl *>(m_control.data()); }

std::unique_ptr<WorkerProcess> WorkerProcess::start(const diatom_call *call, const std::string &folder)
{
   const auto program = workerProgram();
   if (program.empty()) {
      refuseCall(call, fmt::format("{} is not beside the program; install Diatom again", kProgram));
      return nullptr;
   }
   auto control = SharedMemory::make(sizeof(WorkerControl));
   auto line = Line::make();
   if (!control || !line) {
      refuseCall(call, control ? line.error().message : control.error().message);
      return nullptr;
   }
   new (control->data()) WorkerControl;
   posix_spawn_file_actions_t actions;
   ::posix_spawn_file_actions_init(&actions);
   ::posix_spawn_file_actions_adddup2(&actions, line->second.get(), kWorkersEnd);
   ::posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO); // stdout is the program's own
   std::string name = program.string();
   const std::array<char *, 2> arguments{name.data(), nullptr};
   pid_t process = -1;
   const int failed = ::posix_spawn(&process, name.c_str(), &actions, nullptr, arguments.data(), environ);
   ::posix_spawn_file_actions_destroy(&actions);
   if (failed != 0) {
      refuseCall(call, fmt::format("{} cannot be started ({})", name, std::strerror(failed)));
      return nullptr;
   }
   line->second.close();
   std::unique_ptr<WorkerProcess> worker(
       new WorkerProcess(std::move(line->first), std::move(*control), process));
   WorkerRequest request;
   request.operation = WorkerOperation::load;
   Answer answer;
   if (worker->ask(call, request, folder, answer, &worker->m_control) != DIATOM_OK)
      return nullptr;
   return worker;
}

std::byte *WorkerProcess::room(const diatom_call *call, std::size_t bytes)
{
   if (m_room.size() < bytes) {
      auto made = SharedMemory::make(std::max<std::size_t>(bytes, 4096));
      if (!made) {
         refuseCall(call, made.error().message, DIATOM_NO_MEMORY);
         return nullptr;
      }
      m_room = std::move(*made);
      m_sent = false;
   }
   return m_room.data();
}
bool WorkerProcess::pack(const diatom_call *call, const SolverInput &input)
{
   std::byte *where = room(call, packedSize(input));
   if (where)
      packInput(input, where);
   return where != nullptr;
}

std::int32_t WorkerProcess::ask(const diatom_call *call, WorkerRequest request, std::string_view text,
                                Answer &answer)
{
   const bool withRoom = m_room.data() && !m_sent;
   return ask(call, request, text, answer, withRoom ? &m_room : nullptr);
}

std::int32_t WorkerProcess::ask(const diatom_call *call, WorkerRequest request, std::string_view text,
                                Answer &answer, const SharedMemory *block)
{
   if (!alive())
      return refuseCall(call, "its process has ended; start the simulation again");
   request.threads = jobOf(call).threads();
   request.bytes = block ? block->size() : 0;
   std::string message;
   putRecord(message, request);
   message.append(text);
   control().cancelled.store(0);
   control().fraction.store(0);
   if (!m_line.send(message, block ? block->descriptor() : -1))
      return ended(call);
   m_sent = m_sent || block == &m_room;
   return wait(call, answer);
}

std::int32_t WorkerProcess::wait(const diatom_call *call, Answer &answer)
{
   const Job &job = jobOf(call);
   std::string message;
   std::optional<Clock::time_point> cancelled;
   double told = 0;
   for (;;) {
      Descriptor none;
      switch (m_line.receive(message, none, kGlance)) {
      case Line::Got::message:
         return taken(call, message, answer);
      case Line::Got::closed:
         return ended(call);
      case Line::Got::nothing:
         break;
      }
      if (const double fraction = control().fraction.load(); fraction > told && fraction <= 1) {
         told = fraction;
         job.progress(fraction, "");
      }
      if (job.cancelled() && !cancelled) {
         cancelled = Clock::now();
         control().cancelled.store(1);
      }
      if (cancelled && secondsSince(*cancelled) > kPatience) {
         ::kill(m_process, SIGKILL);
         end();
         return refuseCall(call,
                           fmt::format("it did not stop within {:.0f} s of being cancelled, and its process "
                                       "was ended; the design is as it was",
                                       kPatience));
      }
   }
}

/// The line is closed: tells how the process ended.
std::int32_t WorkerProcess::ended(const diatom_call *call)
{
   const int status = end();
   if (WIFSIGNALED(status))
      return refuseCall(call, fmt::format("its process ended in a crash ({}); the design is as it was",
                                          ::strsignal(WTERMSIG(status))));
   return refuseCall(call, "its process ended before it was done; the design is as it was");
}

/// Closes the line and waits for the process, which ends at once or is ended. Its exit status.
int WorkerProcess::end()
{
   if (m_process <= 0)
      return 0;
   m_line.close();
   int status = 0;
   // A crash has its status a moment after the line closes.
   for (int look = 0; look < 100; ++look) {
      const pid_t gone = ::waitpid(m_process, &status, WNOHANG);
      if (gone == m_process || (gone < 0 && errno != EINTR)) {
         m_process = -1;
         return status;
      }
      ::usleep(look < 10 ? 200 : 10'000);
   }
   ::kill(m_process, SIGKILL);
   while (::waitpid(m_process, &status, 0) < 0 && errno == EINTR) {
   }
   m_process = -1;
   return status;
}

} // namespace diatom
