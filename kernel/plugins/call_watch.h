// Watches that a plugin answers to cancel, and names the one that does not.
#pragma once

#include "core/job.h"

#include <string>

namespace diatom {

/// One call into a plugin, as long as it lives. When it still runs 10 s after its job was cancelled, one
/// sentence says so through warnOfPlugin(): in process there is nothing to do but wait or quit.
class CallWatch
{
public:
   CallWatch(const std::string &who, const char *function, const Job &job);
   ~CallWatch();
   CallWatch(const CallWatch &) = delete;
   CallWatch &operator=(const CallWatch &) = delete;

private:
   void *m_entry;
};

/// For tests: another time than 10 s.
void setCancelPatience(double seconds);
/// In a child process, which has none of its parent's threads: calls are no longer watched.
void stopWatchingCalls();

} // namespace diatom
