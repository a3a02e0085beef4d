// Findings in groups, and the page that tells them.
#include "verify/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

namespace diatom {

namespace {

/// The path with * for positions in lists and for what an index names, so that alike values look alike.
std::string generalPath(const std::string &path)
{
   std::string out;
   std::size_t begin = 0;
   while (begin <= path.size()) {
      const std::size_t end = std::min(path.find('.', begin), path.size());
      const std::string part = path.substr(begin, end - begin);
      const bool number = !part.empty() && std::all_of(part.begin(), part.end(),
                                                       [](unsigned char c) { return std::isdigit(c) != 0; });
      out += (out.empty() ? "" : ".") + (number ? std::string("*") : part);
      begin = end + 1;
   }
   return out;
}

double excess(const Finding &finding)
{
   if (finding.verdict != Finding::Verdict::pass && finding.verdict != Finding::Verdict::fail)
      return 0;
   return finding.tolerance > 0 ? finding.error / finding.tolerance : finding.error;
}

std::string numbers(const std::vector<double> &values, const std::string &word)
{
   constexpr std::size_t kMost = 3;
   if (!word.empty())
      return word;
   std::string out;
   for (std::size_t i = 0; i < std::min(values.size(), kMost); ++i)
      out += fmt::format("{}{:.6g}", i > 0 ? ", " : "", values[i]);
   if (values.size() > kMost)
      out += fmt::format(", ... ({})", values.size());
   return out;
}

/// As a table's cell takes it.
std::string escaped(const std::string &text)
{
   std::string out;
   for (const char c : text)
      if (c == '|' || c == '*')
         out += std::string{'\\', c};
      else
         out += c;
   return out;
}

void appendCase(const CaseReport &report, std::string &page)
{
   Tally tally;
   tally.add(report);
   page += fmt::format("\n## {}: {}\n\n", report.id, report.name);
   if (!report.description.empty())
      page += report.description + "\n\n";
   page += "| value | of these | computed | reference | error | tolerance | verdict "
           "|\n|---|---|---|---|---|---|---|\n";
   std::map<std::string, std::vector<std::string>> reasons;
   for (const FindingGroup &group : groupFindings(report.findings)) {
      const Finding &worst = group.worst;
      if (worst.verdict == Finding::Verdict::notComputed || worst.verdict == Finding::Verdict::later) {
         reasons[worst.note].push_back(fmt::format("`{}` ({})", group.path, group.count));
         continue;
      }
      std::string measure =
          worst.measure == "relative" || worst.measure == "as told" ? "" : " " + worst.measure;
      page += fmt::format("| {}{} | {} | {} | {} | {:.1e} | {:.1e}{} | {} |\n", escaped(group.path),
                          worst.note.empty() ? "" : " (" + escaped(worst.note) + ")", group.count,
                          numbers(worst.computed, worst.computedWord),
                          numbers(worst.reference, worst.referenceWord), worst.error, worst.tolerance,
                          measure, verdictText(worst.verdict));
   }
   for (const auto &[why, paths] : reasons)
      page += fmt::format("\nNot computed: {}: {}.\n", fmt::join(paths, ", "), why);
}

} // namespace

std::vector<FindingGroup> groupFindings(const std::vector<Finding> &findings)
{
   std::vector<FindingGroup> groups;
   std::map<std::string, std::size_t> known;
   for (const Finding &finding : findings) {
      const std::string path = generalPath(finding.path);
      // Failures and reasons stand alone; values held against one reference by several models do not mix.
      const std::string key =
          fmt::format("{}\n{}\n{}", path, static_cast<int>(finding.verdict), finding.note);
      const auto [at, added] = known.try_emplace(key, groups.size());
      if (added)
         groups.push_back({path, 0, finding});
      FindingGroup &group = groups[at->second];
      ++group.count;
      if (excess(finding) > excess(group.worst))
         group.worst = finding;
   }
   return groups;
}

std::string verificationPage(const std::vector<CaseReport> &reports)
{
   Tally all;
   for (const CaseReport &report : reports)
      all.add(report);
   std::string page = fmt::format(
       "# Verification\n\n"
       "What the shipped solver answers to questions whose answers were found in another way: in closed "
       "form, by "
       "assembled or\nintegrated solutions, by other programs. This page is what `diatom verify --markdown` "
       "wrote; "
       "docs/verification-cases.md says\nhow cases are made.\n\n"
       "Each line tells values of one kind, and of them the one that is nearest to its tolerance, or beyond. "
       "Errors "
       "are relative\nunless the tolerance says of what they are. Models: a is the thesis' shear-dominated "
       "bond, b "
       "Timoshenko's beam, c Euler and\nBernoulli's, each with the mean of unlike cells' constants; b_exact "
       "joins two "
       "half beams.\n\n"
       "{} values pass, {} fail, {} are not computed, for reasons that are told, and {} wait for what is not "
       "simulated yet.\n\n"
       "| case | form | pass | fail | not computed | later |\n|---|---|---|---|---|---|\n",
       all.pass, all.fail, all.notComputed, all.later);
   for (const CaseReport &report : reports) {
      Tally tally;
      tally.add(report);
      page += fmt::format("| [{0}](#{0}) | {1} | {2} | {3} | {4} | {5} |\n", report.id, report.form,
                          tally.pass, tally.fail, tally.notComputed, tally.later);
   }
   for (const CaseReport &report : reports)
      appendCase(report, page);
   return page;
}

} // namespace diatom
