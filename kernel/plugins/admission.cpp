#include "plugins/admission.h"

#include "plugins/catalogue.h"
#include "plugins/crash_note.h"
#include "plugins/trial.h"
#include "plugins/trust.h"
#include "plugins/verdicts.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

std::string quarantined(const Candidate &candidate, const TrialFinding &finding)
{
   return fmt::format("{}; it is not used until its file changes or you run `diatom plugins retry {}`",
                      finding.text, candidate.manifest.id);
}

std::string untrusted(const Candidate &candidate)
{
   return fmt::format(
       "it lies in your own plugin folder and may do whatever you may; if you trust its author, run "
       "`diatom plugins trust {}`",
       candidate.manifest.id);
}

/// Plugins that were being called when the program crashed are turned away like those that crash on trial.
void rememberCrashes(const std::vector<Candidate> &candidates, Verdicts &verdicts)
{
   for (const CrashNote &note : takeCrashNotes())
      for (const Candidate &candidate : candidates) {
         const auto &provides = candidate.manifest.provides;
         if (candidate.origin != Origin::installed && candidate.accepted &&
             std::any_of(provides.begin(), provides.end(),
                         [&](const Provided &provided) { return provided.id == note.who; }))
            verdicts.remember(candidate.library(), {true, fmt::format("{} crashed Diatom in its function {}",
                                                                      note.who, note.function)});
      }
}

/// What the trial of a library found, now or earlier.
Result<TrialFinding> findingOf(const Candidate &candidate, Verdicts &verdicts, const Job &job)
{
   if (const auto known = verdicts.finding(candidate.library()))
      return *known;
   auto found = tryLibrary(candidate.manifest, job);
   if (found)
      verdicts.remember(candidate.library(), *found);
   return found;
}

void judge(Candidate &candidate, Verdicts &verdicts, const std::set<std::string> &trusted, bool tryUnknown)
{
   const auto refuse = [&](std::string why) {
      candidate.accepted = false;
      candidate.verdict = std::move(why);
   };
   if (candidate.origin == Origin::user) {
      const auto hash = verdicts.hash(candidate.library());
      if (!hash)
         return refuse(hash.error().message);
      if (!trusted.contains(*hash)) {
         candidate.needsConsent = true;
         return refuse(untrusted(candidate));
      }
   }
   const Job job;
   auto finding = verdicts.finding(candidate.library());
   if (!finding && tryUnknown)
      if (const auto found = findingOf(candidate, verdicts, job))
         finding = *found;
   if (!finding)
      return;
   if (finding->refused)
      return refuse(quarantined(candidate, *finding));
   if (!finding->text.empty())
      candidate.verdict = "ok, but " + finding->text;
}

} // namespace

void judgeOutsiders(std::vector<Candidate> &candidates, bool tryUnknown)
{
   const auto outside = [](const Candidate &candidate) {
      return candidate.accepted && candidate.origin != Origin::installed;
   };
   if (std::none_of(candidates.begin(), candidates.end(), outside))
      return;
   Verdicts verdicts;
   rememberCrashes(candidates, verdicts);
   const bool users = std::any_of(candidates.begin(), candidates.end(),
                                  [](const Candidate &one) { return one.origin == Origin::user; });
   const std::set<std::string> trusted = users ? trustedLibraries() : std::set<std::string>();
   for (Candidate &candidate : candidates)
      if (outside(candidate))
         judge(candidate, verdicts, trusted, tryUnknown);
   verdicts.save();
}

Status admit(const Candidate &candidate, const Job &job)
{
   if (candidate.origin == Origin::installed)
      return {};
   const auto refusal = [&](const std::string &why) {
      return Error{ErrorCode::unsupported, fmt::format("{}: {}", candidate.library().string(), why)};
   };
   if (candidate.origin == Origin::user) {
      const auto hash = libraryHash(candidate.library()); // the bytes themselves, whatever their time says
      if (!hash)
         return hash.error();
      if (!trustedLibraries().contains(*hash))
         return refusal(untrusted(candidate));
   }
   Verdicts verdicts;
   const auto finding = findingOf(candidate, verdicts, job);
   verdicts.save();
   if (!finding)
      return finding.error();
   if (finding->refused)
      return refusal(quarantined(candidate, *finding));
   leaveNotesOfCrashes();
   return {};
}

} // namespace diatom
