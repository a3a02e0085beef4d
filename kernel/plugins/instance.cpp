#include "plugins/instance.h"

#include "plugins/call_watch.h"
#include "plugins/crash_note.h"
#include "plugins/module.h"
#include "plugins/process_state.h"
#include "plugins/warnings.h"

#include <fmt/format.h>

#include <cstdlib>
#include <mutex>
#include <string_view>
#include <vector>

namespace diatom {

namespace {

struct FreeScratch
{
   void operator()(void *memory) const { std::free(memory); }
};

/// What stands behind a diatom_call while it lasts.
struct HostCall
{
   const Job *job = nullptr;
   const char *who = nullptr, *function = nullptr;
   std::mutex mutex;
   std::string text;     // of errors and warnings reported, in order
   std::string warnings; // of warnings alone
   std::vector<std::unique_ptr<void, FreeScratch>> scratch;
};

HostCall &host(const diatom_call *call) { return *static_cast<HostCall *>(call->host); }

void report(const diatom_call *call, std::int32_t level, const char *text)
{
   if (level < DIATOM_WARNING || !text)
      return;
   HostCall &self = host(call);
   const std::lock_guard lock(self.mutex);
   const auto add = [&](std::string &to) { to += (to.empty() ? "" : "; ") + std::string(text); };
   add(self.text);
   if (level == DIATOM_WARNING)
      add(self.warnings);
}

std::int32_t cancelled(const diatom_call *call) { return host(call).job->cancelled() ? 1 : 0; }

void progress(const diatom_call *call, double fraction, const char *what)
{
   host(call).job->progress(fraction, what ? what : "");
}

std::int32_t parallelFor(const diatom_call *call, std::int64_t count, std::int64_t grain,
                         void (*body)(void *, std::int64_t, std::int64_t), void *context)
{
   if (!body || count < 0)
      return DIATOM_BAD_INPUT;
   const HostCall &self = host(call);
   self.job->parallelFor(count, grain, [=, &self](std::int64_t begin, std::int64_t end) {
      const CallNote note(self.who, self.function); // the threads that help are not the one that called
      body(context, begin, end);
   });
   return DIATOM_OK;
}

void *scratch(const diatom_call *call, std::int64_t bytes)
{
   constexpr std::size_t kAlignment = 64;
   if (bytes < 0)
      return nullptr;
   const std::size_t rounded = (static_cast<std::size_t>(bytes) + kAlignment) / kAlignment * kAlignment;
   HostCall &self = host(call);
   const std::lock_guard lock(self.mutex);
   self.scratch.emplace_back(std::aligned_alloc(kAlignment, rounded));
   return self.scratch.back().get();
}

const void *service(const diatom_call *, const char *) { return nullptr; }

ErrorCode codeOf(std::int32_t status)
{
   switch (status) {
   case DIATOM_CANCELLED:
      return ErrorCode::cancelled;
   case DIATOM_UNSUPPORTED:
      return ErrorCode::unsupported;
   case DIATOM_BAD_INPUT:
   case DIATOM_LIMIT:
      return ErrorCode::invalid;
   default:
      return ErrorCode::internal;
   }
}

const char *nameOf(std::int32_t status)
{
   switch (status) {
   case DIATOM_CANCELLED:
      return "it was cancelled";
   case DIATOM_UNSUPPORTED:
      return "it does not support this";
   case DIATOM_BAD_INPUT:
      return "it refused its input";
   case DIATOM_NO_MEMORY:
      return "it ran out of memory";
   case DIATOM_EXCEPTION:
      return "it failed inside";
   case DIATOM_NOT_FINITE:
      return "a number was not finite";
   case DIATOM_LIMIT:
      return "a limit was exceeded";
   case DIATOM_INTERNAL:
      return "it failed inside";
   default:
      return "it returned an unknown status";
   }
}

/// Steps and reads come thousands of times a second.
ProcessState::Depth depthFor(std::string_view function)
{
   return function == "step" || function == "read" ? ProcessState::Depth::quick
                                                   : ProcessState::Depth::thorough;
}

void warnOfChange(const std::string &who, const char *function, const std::string &changed)
{
   if (!changed.empty())
      warnOfPlugin(fmt::format("{} ({}) changed {}, which a plugin must not do; it was put back", who,
                               function, changed));
}

} // namespace

const Job &jobOf(const diatom_call *call) { return *host(call).job; }

Status guardedCall(const std::string &who, const char *function, const Job &job,
                   const std::function<std::int32_t(const diatom_call *)> &call)
{
   HostCall state;
   state.job = &job;
   state.who = who.c_str();
   state.function = function;
   const diatom_call record{sizeof(diatom_call), &state,  report, cancelled, progress,
                            parallelFor,         scratch, service};
   ProcessState process(depthFor(function));
   std::int32_t status = DIATOM_EXCEPTION;
   try {
      const CallNote note(state.who, function);
      const CallWatch watch(who, function, job);
      status = call(&record);
   } catch (...) {
      report(&record, DIATOM_ERROR, "it let an exception out, which the plugin contract forbids");
   }
   warnOfChange(who, function, process.restore());
   if (status == DIATOM_OK) {
      if (!state.warnings.empty())
         warnOfPlugin(who + ": " + state.warnings, PluginWarning::remark);
      return {};
   }
   return Error{codeOf(status),
                fmt::format("{} ({}): {}", who, function, state.text.empty() ? nameOf(status) : state.text)};
}

Instance::Instance(std::shared_ptr<const Module> module, std::string id, const void *table, void *self,
                   Destroy destroy)
    : m_module(std::move(module)), m_id(std::move(id)), m_table(table), m_self(self), m_destroy(destroy)
{}

Instance::~Instance()
{
   ProcessState process;
   {
      const CallNote note(m_id.c_str(), "destroy");
      m_destroy(m_self);
   }
   warnOfChange(m_id, "destroy", process.restore());
}

Status Instance::call(const char *function, const Job &job,
                      const std::function<std::int32_t(const diatom_call *)> &call) const
{
   std::int32_t status = DIATOM_EXCEPTION; // what stays when an exception comes out
   Status done =
       guardedCall(m_id, function, job, [&](const diatom_call *host) { return status = call(host); });
   if (status == DIATOM_EXCEPTION && m_module)
      m_module->noteException();
   return done;
}

} // namespace diatom
