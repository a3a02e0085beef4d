// A plugin library tried in a process of its own, so that one that crashes or hangs costs a sentence.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "plugins/manifest.h"
#include "plugins/verdicts.h"

namespace diatom {

/// Loads the library in a child process, makes and destroys what it provides with default values, and looks
/// at what it leaves behind. A library that cannot be loaded is no finding: loading says why. Error only when
/// cancelled.
Result<TrialFinding> tryLibrary(const Manifest &manifest, const Job &job);

} // namespace diatom
