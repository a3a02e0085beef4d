// Runs verification cases, and tells what became of them.
#pragma once

#include "verify/findings.h"

#include "core/job.h"
#include "plugins/catalogue.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace diatom {

struct CaseReport
{
   std::string file, id, form, name, description;
   std::vector<Finding> findings;
   double seconds = 0;
};

struct Tally
{
   std::size_t pass = 0, fail = 0, notComputed = 0, later = 0;
   void add(const CaseReport &report);
};

/// Errors: a case that lacks what its form needs, in one sentence; cancelled. What the solver cannot do is a
/// finding.
Result<CaseReport> verifyCase(const Case &one, const std::shared_ptr<const Catalogue> &catalogue,
                              const Job &job);

const char *verdictText(Finding::Verdict verdict);

/// Findings of one kind, told in one line: their paths with * for whatever differs, and the worst of them.
struct FindingGroup
{
   std::string path;
   std::size_t count = 0;
   Finding worst;
};
std::vector<FindingGroup> groupFindings(const std::vector<Finding> &findings);

/// A page in the manner of a verification manual.
std::string verificationPage(const std::vector<CaseReport> &reports);

} // namespace diatom
