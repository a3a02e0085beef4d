// Work on files of doubtful origin in a process of its own, so that a fault of it costs a message.
#pragma once

#include "core/job.h"
#include "core/result.h"

#include <functional>
#include <string>
#include <string_view>

namespace diatom {

/// Tells how much of the work is done, 0 to 1. May be called as often as one likes.
using ChildProgress = std::function<void(double fraction)>;

/// Runs `work` in a child process and returns its bytes; its progress is the job's, as `what`. A crash, or
/// more than `seconds` of time, is an Error that says so without naming what was worked on; cancelling kills
/// the child. The work may throw nothing, sees a copy of everything, and must use no threads. Without a child
/// to be had it runs in place.
Result<std::string> runInChild(const std::function<std::string(const ChildProgress &)> &work, double seconds,
                               std::string_view what, const Job &job);

} // namespace diatom
