// What a plugin from outside the installation must pass before its code runs in this process.
#pragma once

#include "core/job.h"
#include "core/result.h"

#include <vector>

namespace diatom {

struct Candidate;

/// Turns away those that the user does not trust, that did not stand their trial or that crashed the program
/// before, as far as it is known; with `tryUnknown`, tries those it is not known of.
void judgeOutsiders(std::vector<Candidate> &candidates, bool tryUnknown);

/// The last look before a library is loaded: consent for the file as it is now, and its trial.
Status admit(const Candidate &candidate, const Job &job);

} // namespace diatom
