#include "plugins/worker_serve.h"

#include "core/job.h"
#include "core/sanitizers.h"
#include "plugins/instance.h"
#include "plugins/manifest.h"
#include "plugins/module.h"
#include "plugins/scene_pack.h"
#include "plugins/warnings.h"
#include "plugins/worker_protocol.h"

#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace diatom {

namespace {

constexpr double kOverEstimate = 4;                        // a solver may take so many times what it said
constexpr double kLeastMemory = 256.0 * 1024 * 1024;       // bytes, whatever it said
constexpr std::size_t kLongestReport = Line::kLongest / 2; // of what a plugin says; the rest is cut

/// Passes the host's wish to stop on to the job that runs.
class CancelWatch
{
public:
   explicit CancelWatch(WorkerControl &control)
       : m_control(control), m_thread([this](const std::stop_token &stop) { watch(stop); })
   {}

   void run(Job &job, const std::function<void()> &work)
   {
      begin(&job);
      work();
      begin(nullptr);
   }

private:
   void begin(Job *job)
   {
      const std::lock_guard lock(m_mutex);
      m_job = job;
   }
   void watch(const std::stop_token &stop)
   {
      while (!stop.stop_requested()) {
         std::this_thread::sleep_for(std::chrono::milliseconds(20));
         const std::lock_guard lock(m_mutex);
         if (m_job && m_control.cancelled.load() != 0)
            m_job->cancel();
      }
   }

   WorkerControl &m_control;
   std::mutex m_mutex;
   Job *m_job = nullptr;
   std::jthread m_thread; // last: ends before what it looks at
};

/// Address space in use now, bytes (proc(5), statm).
double memoryInUse()
{
   std::ifstream statm("/proc/self/statm");
   double pages = 0;
   statm >> pages;
   return pages * 4096;
}

void limitMemory(double estimated)
{
   if (!kMayLimitMemory)
      return;
   const double most = memoryInUse() + std::max(kLeastMemory, kOverEstimate * estimated);
   rlimit limit{};
   if (::getrlimit(RLIMIT_AS, &limit) != 0 || most > 1e18)
      return;
   limit.rlim_cur = std::min(limit.rlim_max, static_cast<rlim_t>(most));
   ::setrlimit(RLIMIT_AS, &limit);
}

class Server
{
public:
   explicit Server(Line line) : m_line(std::move(line))
   {
      setPluginWarnings([this](const std::string &sentence, PluginWarning kind) {
         if (kind == PluginWarning::remark)
            m_remarks += (m_remarks.empty() ? "" : "; ") + withoutName(sentence, ": ");
         else
            std::fprintf(stderr, "%s\n", sentence.c_str());
      });
   }
   ~Server()
   {
      setPluginWarnings({});
      if (m_self)
         m_table->destroy(m_self); // it may have more to end than memory
   }
   Server(const Server &) = delete;
   Server &operator=(const Server &) = delete;

   int run()
   {
      std::string message;
      Descriptor descriptor;
      for (;;) {
         switch (m_line.receive(message, descriptor, -1)) {
         case Line::Got::closed:
            return 0;
         case Line::Got::nothing:
            continue;
         case Line::Got::message:
            break;
         }
         std::string_view rest = message;
         WorkerRequest request;
         if (!takeRecord(rest, request) || !answer(request, std::string(rest), std::move(descriptor)))
            return 1;
      }
   }

private:
   struct Answer
   {
      WorkerReply reply;
      std::string report;
      std::vector<std::string> texts;
   };

   bool answer(const WorkerRequest &request, const std::string &text, Descriptor descriptor)
   {
      Answer answer;
      m_threads = request.threads;
      if (descriptor) {
         auto memory = SharedMemory::map(std::move(descriptor), request.bytes);
         if (!memory)
            return false;
         m_memory = std::move(*memory);
      }
      if (request.operation == WorkerOperation::load)
         load(text, answer);
      else if (m_table)
         operate(request, text, answer);
      else
         return false;
      std::string message;
      answer.reply.texts = static_cast<std::int32_t>(answer.texts.size());
      putRecord(message, answer.reply);
      putText(message, std::string_view(answer.report).substr(0, kLongestReport));
      for (const std::string &one : answer.texts)
         putText(message, one);
      return m_line.send(message);
   }

   /// The host names plugin and function itself.
   static std::string withoutName(const std::string &sentence, const std::string &name)
   {
      return sentence.starts_with(name) ? sentence.substr(name.size()) : sentence;
   }

   static void refuse(Answer &answer, std::string why)
   {
      answer.reply.status = DIATOM_INTERNAL;
      answer.report = std::move(why);
   }

   void load(const std::string &folder, Answer &answer)
   {
      if (m_memory.size() < sizeof(WorkerControl))
         return refuse(answer, "the worker got no control page");
      m_control = std::move(m_memory);
      m_memory = {};
      m_watch = std::make_unique<CancelWatch>(control());
      auto manifest = readManifest(folder);
      if (!manifest)
         return refuse(answer, manifest.error().message);
      m_folder = folder;
      auto module = Module::load(*manifest);
      if (!module)
         return refuse(answer, module.error().message);
      m_module = *module;
      m_table = static_cast<const diatom_solver *>(m_module->table(DIATOM_SOLVER_1));
      if (!m_table)
         refuse(answer, fmt::format("it provides no {}", DIATOM_SOLVER_1));
   }

   WorkerControl &control() { return *reinterpret_cast<WorkerControl *>(m_control.data()); }

   /// One call into the plugin, by the guard that calls in the host's process go through.
   void call(Answer &answer, const char *function,
             const std::function<std::int32_t(const diatom_call *)> &body)
   {
      Job job([this](double fraction, std::string_view) { control().fraction.store(fraction); });
      job.setThreads(m_threads);
      m_watch->run(job, [&] {
         std::int32_t status = DIATOM_OK;
         const Status done = guardedCall("", function, job, [&](const diatom_call *record) {
            status = body(record);
            return status;
         });
         answer.report = std::exchange(m_remarks, {});
         if (done)
            return;
         answer.reply.status = status == DIATOM_OK ? DIATOM_EXCEPTION : status;
         answer.report = withoutName(done.error().message, fmt::format(" ({}): ", function));
      });
   }

   std::unique_ptr<UnpackedInput> input(Answer &answer)
   {
      auto unpacked = UnpackedInput::of(m_memory.data(), m_memory.size());
      if (unpacked)
         return *std::move(unpacked);
      refuse(answer, unpacked.error().message);
      return nullptr;
   }

   void operate(const WorkerRequest &request, const std::string &text, Answer &answer)
   {
      switch (request.operation) {
      case WorkerOperation::capabilities:
         return capabilities(text, answer);
      case WorkerOperation::estimate:
         return estimate(text, answer);
      case WorkerOperation::create:
         return create(text, answer);
      case WorkerOperation::load:
         return;
      default:
         break;
      }
      if (!m_self)
         return refuse(answer, "the worker has made no solver");
      switch (request.operation) {
      case WorkerOperation::apply:
         if (const auto packed = input(answer))
            call(answer, "apply", [&](const diatom_call *record) {
               const auto &channels = packed->channels();
               return m_table->apply(m_self, record, channels.data(),
                                     static_cast<std::int64_t>(channels.size()));
            });
         return;
      case WorkerOperation::step:
         answer.reply.step.size = sizeof answer.reply.step;
         return call(answer, "step", [&](const diatom_call *record) {
            return m_table->step(m_self, record, &request.step, &answer.reply.step);
         });
      case WorkerOperation::outputs:
         return outputs(answer);
      default:
         return read(request, answer);
      }
   }

   void capabilities(const std::string &id, Answer &answer)
   {
      const diatom_capabilities *found = nullptr;
      call(answer, "capabilities", [&](const diatom_call *record) {
         const std::int32_t status = m_table->capabilities(record, id.c_str(), &found);
         return status == DIATOM_OK && !found ? DIATOM_INTERNAL : status;
      });
      if (answer.reply.status != DIATOM_OK)
         return;
      const auto list = [&](std::int64_t count, const char *const *names) {
         answer.texts.push_back(std::to_string(names ? count : 0));
         for (std::int64_t k = 0; names && k < count; ++k)
            answer.texts.emplace_back(names[k] ? names[k] : "");
      };
      list(found->physics, found->physics_name);
      list(found->analyses, found->analysis_name);
      list(found->effects, found->effect_name);
      list(found->lattices, found->lattice);
      answer.texts.push_back(std::to_string(found->deterministic));
   }

   void estimate(const std::string &id, Answer &answer)
   {
      const auto packed = input(answer);
      if (!packed)
         return;
      const diatom_create create{sizeof create, id.c_str(), m_folder.c_str(), &packed->values()};
      diatom_estimate &estimate = answer.reply.estimate;
      estimate.size = sizeof estimate;
      estimate.stable_link = -1;
      call(answer, "estimate", [&](const diatom_call *record) {
         return m_table->estimate(record, &create, &packed->scene(), &estimate);
      });
      m_estimated = estimate.bytes > 0 ? estimate.bytes : 0;
   }

   void create(const std::string &id, Answer &answer)
   {
      const auto packed = input(answer);
      if (!packed)
         return;
      if (m_self)
         return refuse(answer, "the worker has made its solver already");
      limitMemory(m_estimated);
      const diatom_create create{sizeof create, id.c_str(), m_folder.c_str(), &packed->values()};
      call(answer, "create", [&](const diatom_call *record) {
         return m_table->create(record, &create, &packed->scene(), &m_self);
      });
      m_memory = {}; // the scene is the largest block of all; the host forgets it too
   }

   void outputs(Answer &answer)
   {
      m_outputs = nullptr;
      call(answer, "outputs", [&](const diatom_call *record) {
         const std::int32_t status = m_table->outputs(m_self, record, &m_outputs);
         return status == DIATOM_OK && !m_outputs ? DIATOM_INTERNAL : status;
      });
      if (answer.reply.status != DIATOM_OK)
         return;
      for (std::int64_t k = 0; k < m_outputs->count; ++k) {
         const diatom_output &output = m_outputs->output[k];
         answer.texts.emplace_back(output.name ? output.name : "");
         answer.texts.emplace_back(output.unit ? output.unit : "");
         answer.texts.push_back(std::to_string(output.count));
         answer.texts.push_back(std::to_string(output.stride));
      }
   }

   void read(const WorkerRequest &request, Answer &answer)
   {
      if (!m_outputs || request.output < 0 || request.output >= m_outputs->count || request.count < 0 ||
          m_memory.size() / sizeof(double) <
              static_cast<std::uint64_t>(request.count) *
                  static_cast<std::uint64_t>(m_outputs->output[request.output].stride))
         return refuse(answer, "the worker was asked for what it does not have");
      call(answer, "read", [&](const diatom_call *record) {
         return m_table->read(m_self, record, request.output, request.first, request.count,
                              reinterpret_cast<double *>(m_memory.data()));
      });
   }

   Line m_line;
   SharedMemory m_control, m_memory; // the last block that came; kept for reads of the same room
   std::unique_ptr<CancelWatch> m_watch;
   std::shared_ptr<const Module> m_module;
   const diatom_solver *m_table = nullptr;
   const diatom_outputs *m_outputs = nullptr;
   std::string m_folder;
   void *m_self = nullptr;
   double m_estimated = 0; // bytes
   int m_threads = 0;
   std::string m_remarks; // of the call under way
};

} // namespace

int serveSolver(Line line) { return Server(std::move(line)).run(); }

} // namespace diatom
