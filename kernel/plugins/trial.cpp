#include "plugins/trial.h"

#include "core/child.h"
#include "core/sanitizers.h"
#include "plugins/c_values.h"
#include "plugins/call_watch.h"
#include "plugins/instance.h"
#include "plugins/module.h"
#include "plugins/process_traces.h"
#include "plugins/warnings.h"

#include <diatom/abi/lattice.h>
#include <diatom/abi/machine.h>
#include <diatom/abi/parts.h>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>

namespace diatom {

namespace {

constexpr double kSeconds = 5; // loading takes milliseconds; a busy machine may take a hundred times that
constexpr rlim_t kMemory = rlim_t{2} << 30;

/// Faults end the child at once, what it prints is lost, and it cannot take the machine's memory.
void isolate()
{
   for (const int signal : kCrashSignals)
      std::signal(signal, SIG_DFL);
   const int nowhere = open("/dev/null", O_RDWR);
   for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      dup2(nowhere, stream);
   const rlimit noCore{0, 0};
   setrlimit(RLIMIT_CORE, &noCore);
   if (!kMayLimitMemory)
      return;
   rlim_t pages = 0; // in use already
   std::ifstream("/proc/self/statm") >> pages;
   const rlim_t most = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + kMemory;
   const rlimit memory{most, most};
   setrlimit(RLIMIT_AS, &memory);
}

/// Makes one thing with its default values and ends it. A refusal is no fault.
template<typename Table>
void makeOne(const Module &module, const Provided &provided, const Manifest &manifest, const Job &job)
{
   const auto *table = static_cast<const Table *>(module.table(provided.interface.c_str()));
   const auto values = completeValues(provided.parameters, {});
   if (!table || !values)
      return;
   const CValues record(*values);
   const std::string folder = manifest.folder.string();
   const diatom_create request{sizeof(diatom_create), provided.id.c_str(), folder.c_str(), &record.record};
   void *self = nullptr;
   const Status made = guardedCall(provided.id, "create", job, [&](const diatom_call *call) {
      return table->create(call, &request, &self);
   });
   if (made.ok() && self)
      table->destroy(self);
}

/// In the child. What the plugin did that it must not.
std::string trial(const Manifest &manifest)
{
   isolate();
   stopWatchingCalls();
   std::string text;
   setPluginWarnings([&](const std::string &sentence, PluginWarning kind) {
      if (kind == PluginWarning::misdeed)
         text += (text.empty() ? "" : "; ") + sentence;
   });
   Job job;
   job.setThreads(1); // a pool of threads does not survive the making of a child
   const ProcessTraces before;
   const auto module = Module::load(manifest);
   if (!module)
      return {};
   for (const Provided &provided : manifest.provides) {
      if (provided.interface == DIATOM_LATTICE_1)
         makeOne<diatom_lattice>(**module, provided, manifest, job);
      else if (provided.interface == DIATOM_PARTS_1)
         makeOne<diatom_parts>(**module, provided, manifest, job);
      else if (provided.interface == DIATOM_MACHINE_1)
         makeOne<diatom_machine>(**module, provided, manifest, job);
   }
   setPluginWarnings({});
   if (const std::string left = ProcessTraces().since(before); !left.empty())
      text += fmt::format("{}{} {}, which a plugin must not do", text.empty() ? "" : "; ", manifest.id, left);
   return text;
}

} // namespace

Result<TrialFinding> tryLibrary(const Manifest &manifest, const Job &job)
{
   const pid_t parent = getpid();
   const auto outcome =
       runInChild([&](const ChildProgress &) { return getpid() == parent ? std::string() : trial(manifest); },
                  kSeconds, "trying a plugin", job);
   if (outcome)
      return TrialFinding{false, *outcome};
   switch (outcome.error().code) {
   case ErrorCode::cancelled:
      return outcome.error();
   case ErrorCode::timeLimit:
      return TrialFinding{true, fmt::format("it hung when it was tried ({:.0f} s)", kSeconds)};
   default:
      return TrialFinding{true, fmt::format("it crashed when it was tried: {}", outcome.error().message)};
   }
}

} // namespace diatom
