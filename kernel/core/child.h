// Work on files of doubtful origin in a process of its own, so that a fault of it costs a message.
#pragma once

#include "core/job.h"
#include "core/result.h"

#include <functional>
#include <string>

namespace diatom {

/// Runs `work` in a child process and returns its bytes. A crash, or more than `seconds` of time, is an Error
/// that says so without naming what was worked on; cancelling kills the child. The work may throw nothing,
/// sees a copy of everything, and must use no threads. Without a child to be had it runs in place.
Result<std::string> runInChild(const std::function<std::string()> &work, double seconds, const Job &job);

} // namespace diatom
