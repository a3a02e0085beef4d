#include "verify/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

double errorOf(std::span<const double> computed, std::span<const double> reference,
               const Tolerance &tolerance)
{
   double difference = 0, size = 0, each = 0;
   for (std::size_t i = 0; i < (tolerance.first > 0 ? tolerance.first : reference.size()); ++i) {
      const double one = std::abs(computed[i] - reference[i]);
      difference = std::max(difference, one);
      size = std::max(size, std::abs(reference[i]));
      each = std::max(each, reference[i] != 0 ? one / std::abs(reference[i]) : one);
      if (!std::isfinite(computed[i]))
         return HUGE_VAL;
   }
   if (tolerance.measure == Tolerance::Measure::each)
      return each;
   const double scale = tolerance.scale > 0 ? tolerance.scale : size;
   return scale > 0 ? difference / scale : difference;
}

} // namespace

Findings::Findings(const Case &one) : m_asked(askedValues(one)), m_found(m_asked.size()) {}

/// As many as there are where the path is not asked for.
std::size_t Findings::numberOf(const std::string &path) const
{
   return static_cast<std::size_t>(std::find_if(m_asked.begin(), m_asked.end(),
                                                [&](const AskedValue &value) { return value.path == path; }) -
                                   m_asked.begin());
}

void Findings::compare(const std::string &path, std::span<const double> computed, const Tolerance &tolerance,
                       std::string note)
{
   const std::size_t number = numberOf(path);
   if (number == m_asked.size())
      return;
   Finding finding;
   finding.path = path;
   finding.verdict = Finding::Verdict::fail;
   finding.computed.assign(computed.begin(), computed.end());
   finding.reference = m_asked[number].numbers;
   finding.tolerance = tolerance.most;
   finding.measure = tolerance.words.empty() ? "relative" : tolerance.words;
   finding.note = std::move(note);
   if (computed.size() != finding.reference.size()) {
      finding.note = fmt::format("{} numbers were computed where {} are asked for", computed.size(),
                                 finding.reference.size());
      finding.error = HUGE_VAL;
   } else {
      finding.error = errorOf(computed, finding.reference, tolerance);
      if (finding.error <= tolerance.most)
         finding.verdict = Finding::Verdict::pass;
   }
   m_found[number].push_back(std::move(finding));
}

void Findings::compareWord(const std::string &path, std::string computed)
{
   const std::size_t number = numberOf(path);
   if (number == m_asked.size())
      return;
   Finding finding;
   finding.path = path;
   finding.referenceWord = m_asked[number].word;
   finding.verdict = computed == finding.referenceWord ? Finding::Verdict::pass : Finding::Verdict::fail;
   finding.computedWord = std::move(computed);
   m_found[number].push_back(std::move(finding));
}

void Findings::check(const std::string &name, double computed, double most, std::string note)
{
   Finding finding;
   finding.path = name;
   finding.verdict = computed <= most ? Finding::Verdict::pass : Finding::Verdict::fail;
   finding.computed = {computed};
   finding.error = computed;
   finding.tolerance = most;
   finding.measure = "as told";
   finding.note = std::move(note);
   m_checks.push_back(std::move(finding));
}

void Findings::skip(std::string pattern, std::string why)
{
   m_reasons.push_back({std::move(pattern), std::move(why), false});
}

void Findings::fail(std::string pattern, std::string why)
{
   m_reasons.push_back({std::move(pattern), std::move(why), true});
}

Finding Findings::missing(const AskedValue &value) const
{
   Finding finding;
   finding.path = value.path;
   finding.reference = value.numbers;
   finding.referenceWord = value.word;
   for (const Reason &reason : m_reasons)
      if (matchesPattern(value.path, reason.pattern)) {
         finding.verdict = reason.failed ? Finding::Verdict::fail : Finding::Verdict::notComputed;
         finding.note = reason.why;
         return finding;
      }
   finding.note = "this form has no way to compute it";
   return finding;
}

std::vector<Finding> Findings::take() &&
{
   std::vector<Finding> all;
   for (std::size_t i = 0; i < m_asked.size(); ++i) {
      if (m_found[i].empty())
         all.push_back(missing(m_asked[i]));
      for (Finding &finding : m_found[i])
         all.push_back(std::move(finding));
   }
   for (Finding &check : m_checks)
      all.push_back(std::move(check));
   // A failure that no asked value shows must be seen all the same.
   for (const Reason &reason : m_reasons) {
      const auto shows = [&](const Finding &finding) {
         return finding.verdict == Finding::Verdict::fail && finding.note == reason.why;
      };
      if (!reason.failed || std::any_of(all.begin(), all.end(), shows))
         continue;
      Finding finding;
      finding.path = reason.pattern;
      finding.verdict = Finding::Verdict::fail;
      finding.note = reason.why;
      all.push_back(std::move(finding));
   }
   return all;
}

} // namespace diatom
