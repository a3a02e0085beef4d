#include "plugins/worker_solver.h"

#include "core/clock.h"
#include "core/text.h"
#include "plugins/instance.h"
#include "plugins/scene_pack.h"
#include "plugins/shared_memory.h"
#include "plugins/worker_protocol.h"

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
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <utility>
#include <vector>

namespace diatom {

namespace {

constexpr int kGlance = 50;      // ms between looks at whether the user has cancelled
constexpr double kPatience = 10; // s that a cancelled solver has to stop
constexpr int kWorkersEnd = 3;   // descriptor of the line in the worker
constexpr const char *kProgram = "diatom-worker";
constexpr const char *kDamaged = "what came from its process is damaged";

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

std::int32_t fail(const diatom_call *call, const std::string &why, std::int32_t status = DIATOM_INTERNAL)
{
   call->report(call, DIATOM_ERROR, why.c_str());
   return status;
}

/// One worker and what it was last sent.
class Worker
{
public:
   struct Answer
   {
      WorkerReply reply;
      std::vector<std::string> texts;
   };

   explicit Worker(Line line, SharedMemory control, pid_t process)
       : m_line(std::move(line)), m_control(std::move(control)), m_process(process)
   {}
   ~Worker() { end(); }
   Worker(const Worker &) = delete;
   Worker &operator=(const Worker &) = delete;

   /// Starts the program and has it load the plugin; null after reporting why not.
   static std::unique_ptr<Worker> start(const diatom_call *call, const std::string &folder);

   bool alive() const { return m_process > 0; }

   /// Room of at least so many bytes that the worker sees with the next request; null after reporting.
   std::byte *room(const diatom_call *call, std::size_t bytes)
   {
      if (m_room.size() < bytes) {
         auto made = SharedMemory::make(std::max<std::size_t>(bytes, 4096));
         if (!made) {
            fail(call, made.error().message, DIATOM_NO_MEMORY);
            return nullptr;
         }
         m_room = std::move(*made);
         m_sent = false;
      }
      return m_room.data();
   }
   void dropRoom() { m_room = {}; }

   bool pack(const diatom_call *call, const SolverInput &input)
   {
      std::byte *where = room(call, packedSize(input));
      if (where)
         packInput(input, where);
      return where != nullptr;
   }

   /// One request and its reply, cancel and progress passed on while it runs.
   std::int32_t ask(const diatom_call *call, WorkerRequest request, std::string_view text, Answer &answer)
   {
      const bool withRoom = m_room.data() && !m_sent;
      return ask(call, request, text, answer, withRoom ? &m_room : nullptr);
   }

private:
   WorkerControl &control() const { return *reinterpret_cast<WorkerControl *>(m_control.data()); }

   std::int32_t ask(const diatom_call *call, WorkerRequest request, std::string_view text, Answer &answer,
                    const SharedMemory *block)
   {
      if (!alive())
         return fail(call, "its process has ended; start the simulation again");
      const Job &job = jobOf(call);
      request.threads = job.threads();
      request.bytes = block ? block->size() : 0;
      std::string message;
      putRecord(message, request);
      message.append(text);
      control().cancelled.store(0);
      control().fraction.store(0);
      if (!m_line.send(message, block ? block->descriptor() : -1))
         return ended(call);
      m_sent = m_sent || block == &m_room;
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
            return fail(call,
                        fmt::format("it did not stop within {:.0f} s of being cancelled, and its process "
                                    "was ended; the design is as it was",
                                    kPatience));
         }
      }
   }

   static std::int32_t taken(const diatom_call *call, std::string_view message, Answer &answer)
   {
      std::string report;
      if (!takeRecord(message, answer.reply) || !takeText(message, report))
         return fail(call, kDamaged);
      answer.texts.resize(static_cast<std::size_t>(std::clamp(answer.reply.texts, 0, 1 << 16)));
      for (std::string &one : answer.texts)
         if (!takeText(message, one))
            return fail(call, kDamaged);
      if (!report.empty())
         call->report(call, DIATOM_ERROR, report.c_str());
      return answer.reply.status;
   }

   /// The line is closed: tells how the process ended.
   std::int32_t ended(const diatom_call *call)
   {
      const int status = end();
      if (WIFSIGNALED(status))
         return fail(call, fmt::format("its process ended in a crash ({}); the design is as it was",
                                       ::strsignal(WTERMSIG(status))));
      return fail(call, "its process ended before it was done; the design is as it was");
   }

   /// Closes the line and waits for the process, which ends at once or is ended. Its exit status.
   int end()
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

   Line m_line;
   SharedMemory m_control, m_room;
   bool m_sent = false; // the worker has m_room
   pid_t m_process;
};

std::unique_ptr<Worker> Worker::start(const diatom_call *call, const std::string &folder)
{
   const auto program = workerProgram();
   if (program.empty()) {
      fail(call, fmt::format("{} is not beside the program; install Diatom again", kProgram));
      return nullptr;
   }
   auto control = SharedMemory::make(sizeof(WorkerControl));
   auto line = Line::make();
   if (!control || !line) {
      fail(call, control ? line.error().message : control.error().message);
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
      fail(call, fmt::format("{} cannot be started ({})", name, std::strerror(failed)));
      return nullptr;
   }
   line->second.close();
   auto worker = std::make_unique<Worker>(std::move(line->first), std::move(*control), process);
   WorkerRequest request;
   request.operation = WorkerOperation::load;
   Answer answer;
   if (worker->ask(call, request, folder, answer, &worker->m_control) != DIATOM_OK)
      return nullptr;
   return worker;
}

/// Lists of names in the reply to `capabilities`, as the record that the host reads.
struct CapabilitiesCopy
{
   std::array<std::vector<std::string>, 4> names; // physics, analyses, effects, lattices
   std::array<std::vector<const char *>, 4> pointers;
   diatom_capabilities record{};

   bool read(const std::vector<std::string> &texts)
   {
      std::size_t at = 0;
      for (std::size_t list = 0; list < names.size(); ++list) {
         const auto count = at < texts.size() ? parseInteger(texts[at++]) : std::nullopt;
         if (!count || *count < 0 || static_cast<std::size_t>(*count) > texts.size() - at)
            return false;
         for (std::int64_t k = 0; k < *count; ++k)
            names[list].push_back(texts[at++]);
         for (const std::string &name : names[list])
            pointers[list].push_back(name.c_str());
      }
      const auto deterministic = at < texts.size() ? parseInteger(texts[at]) : std::nullopt;
      record.size = sizeof record;
      record.physics = static_cast<std::int32_t>(names[0].size());
      record.physics_name = pointers[0].data();
      record.analyses = static_cast<std::int32_t>(names[1].size());
      record.analysis_name = pointers[1].data();
      record.effects = static_cast<std::int64_t>(names[2].size());
      record.effect_name = pointers[2].data();
      record.lattices = static_cast<std::int64_t>(names[3].size());
      record.lattice = pointers[3].data();
      record.deterministic = deterministic.value_or(0);
      return deterministic.has_value();
   }
};

/// Solvers from outside by id. The table's functions have no other way to know the plugin.
class Registry
{
public:
   void add(const Manifest &manifest, const std::string &id)
   {
      const std::lock_guard lock(m_mutex);
      Entry &entry = m_entries[id];
      if (entry.folder != manifest.folder.string())
         entry = {manifest.folder.string(), nullptr, nullptr};
   }

   /// The worker that made the estimate, or a new one; null after reporting why there is none.
   std::unique_ptr<Worker> take(const diatom_call *call, const std::string &id)
   {
      std::string folder;
      {
         const std::lock_guard lock(m_mutex);
         Entry &entry = m_entries[id];
         if (entry.spare && entry.spare->alive())
            return std::move(entry.spare);
         entry.spare.reset();
         folder = entry.folder;
      }
      return Worker::start(call, folder);
   }
   void put(const std::string &id, std::unique_ptr<Worker> worker)
   {
      const std::lock_guard lock(m_mutex);
      m_entries[id].spare = std::move(worker);
   }

   std::shared_ptr<const CapabilitiesCopy> capabilities(const std::string &id)
   {
      const std::lock_guard lock(m_mutex);
      return m_entries[id].capabilities;
   }
   /// Kept as long as the process, as the contract says of capabilities.
   const diatom_capabilities *keep(const std::string &id, std::shared_ptr<const CapabilitiesCopy> copy)
   {
      const std::lock_guard lock(m_mutex);
      m_kept.push_back(copy);
      m_entries[id].capabilities = std::move(copy);
      return &m_kept.back()->record;
   }

private:
   struct Entry
   {
      std::string folder;
      std::shared_ptr<const CapabilitiesCopy> capabilities;
      std::unique_ptr<Worker> spare;
   };
   std::mutex m_mutex;
   std::map<std::string, Entry> m_entries;
   std::vector<std::shared_ptr<const CapabilitiesCopy>> m_kept;
};

Registry &registry()
{
   static Registry solvers;
   return solvers;
}

struct RemoteSolver
{
   std::unique_ptr<Worker> worker;
   std::vector<std::string> texts; // of outputs
   std::vector<diatom_output> output;
   diatom_outputs outputs{};
};

RemoteSolver &remote(void *self) { return *static_cast<RemoteSolver *>(self); }

std::int32_t capabilities(const diatom_call *call, const char *id, const diatom_capabilities **caps)
{
   if (const auto known = registry().capabilities(id)) {
      *caps = &known->record;
      return DIATOM_OK;
   }
   auto worker = registry().take(call, id);
   if (!worker)
      return DIATOM_INTERNAL;
   WorkerRequest request;
   request.operation = WorkerOperation::capabilities;
   Worker::Answer answer;
   if (const std::int32_t status = worker->ask(call, request, id, answer); status != DIATOM_OK)
      return status;
   auto copy = std::make_shared<CapabilitiesCopy>();
   if (!copy->read(answer.texts))
      return fail(call, kDamaged);
   *caps = registry().keep(id, std::move(copy));
   registry().put(id, std::move(worker));
   return DIATOM_OK;
}

std::int32_t estimate(const diatom_call *call, const diatom_create *create, const diatom_scene *scene,
                      diatom_estimate *found)
{
   auto worker = registry().take(call, create->id);
   if (!worker || !worker->pack(call, {create->values, scene, nullptr, 0}))
      return DIATOM_INTERNAL;
   WorkerRequest request;
   request.operation = WorkerOperation::estimate;
   Worker::Answer answer;
   const std::int32_t status = worker->ask(call, request, create->id, answer);
   if (status == DIATOM_OK)
      std::memcpy(found, &answer.reply.estimate,
                  std::min(static_cast<std::size_t>(found->size), sizeof answer.reply.estimate));
   registry().put(create->id, std::move(worker));
   return status;
}

std::int32_t create(const diatom_call *call, const diatom_create *create, const diatom_scene *scene,
                    void **self)
{
   auto solver = std::make_unique<RemoteSolver>();
   solver->worker = registry().take(call, create->id);
   if (!solver->worker || !solver->worker->pack(call, {create->values, scene, nullptr, 0}))
      return DIATOM_INTERNAL;
   WorkerRequest request;
   request.operation = WorkerOperation::create;
   Worker::Answer answer;
   const std::int32_t status = solver->worker->ask(call, request, create->id, answer);
   solver->worker->dropRoom();
   if (status == DIATOM_OK)
      *self = solver.release();
   return status;
}

std::int32_t apply(void *self, const diatom_call *call, const diatom_channel *channels, std::int64_t count)
{
   Worker &worker = *remote(self).worker;
   if (!worker.pack(call, {nullptr, nullptr, channels, count}))
      return DIATOM_NO_MEMORY;
   WorkerRequest request;
   request.operation = WorkerOperation::apply;
   Worker::Answer answer;
   return worker.ask(call, request, "", answer);
}

std::int32_t step(void *self, const diatom_call *call, const diatom_step_request *asked,
                  diatom_step_result *result)
{
   WorkerRequest request;
   request.operation = WorkerOperation::step;
   request.step = *asked;
   Worker::Answer answer;
   answer.reply.step.bad_cell = answer.reply.step.bad_link = -1;
   const std::int32_t status = remote(self).worker->ask(call, request, "", answer);
   // Also of a step that was cancelled; nothing of one whose process is gone.
   if (status == DIATOM_OK || answer.reply.step.size > 0)
      std::memcpy(result, &answer.reply.step,
                  std::min(static_cast<std::size_t>(result->size), sizeof answer.reply.step));
   return status;
}

std::int32_t outputs(void *self, const diatom_call *call, const diatom_outputs **list)
{
   RemoteSolver &solver = remote(self);
   WorkerRequest request;
   request.operation = WorkerOperation::outputs;
   Worker::Answer answer;
   if (const std::int32_t status = solver.worker->ask(call, request, "", answer); status != DIATOM_OK)
      return status;
   solver.texts = std::move(answer.texts);
   solver.output.clear();
   for (std::size_t k = 0; k + 3 < solver.texts.size(); k += 4) {
      const auto rows = parseInteger(solver.texts[k + 2]), stride = parseInteger(solver.texts[k + 3]);
      if (!rows || !stride || *rows < 0 || *stride < 1 || *stride > 1'000'000)
         return fail(call, kDamaged);
      solver.output.push_back({solver.texts[k].c_str(), solver.texts[k + 1].c_str(), *rows, *stride});
   }
   solver.outputs = {sizeof solver.outputs, static_cast<std::int64_t>(solver.output.size()),
                     solver.output.data()};
   *list = &solver.outputs;
   return DIATOM_OK;
}

std::int32_t read(void *self, const diatom_call *call, std::int64_t output, std::int64_t first,
                  std::int64_t count, double *values)
{
   RemoteSolver &solver = remote(self);
   if (output < 0 || output >= solver.outputs.count)
      return fail(call, "it has no such output");
   const auto bytes = sizeof(double) * static_cast<std::size_t>(
                                           count * solver.output[static_cast<std::size_t>(output)].stride);
   const std::byte *room = solver.worker->room(call, bytes);
   if (!room)
      return DIATOM_NO_MEMORY;
   WorkerRequest request;
   request.operation = WorkerOperation::read;
   request.output = output;
   request.first = first;
   request.count = count;
   Worker::Answer answer;
   const std::int32_t status = solver.worker->ask(call, request, "", answer);
   if (status == DIATOM_OK)
      std::memcpy(values, room, bytes);
   return status;
}

void destroy(void *self) { delete static_cast<RemoteSolver *>(self); }

} // namespace

const diatom_solver *workerSolver(const Manifest &manifest, const std::string &id)
{
   static constexpr diatom_solver kTable{capabilities, estimate, create, apply, step, outputs, read, destroy};
   registry().add(manifest, id);
   return &kTable;
}

} // namespace diatom
