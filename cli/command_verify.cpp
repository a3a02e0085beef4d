// diatom verify: the shipped solver against answers that were found in another way.
#include "cli/commands.h"
#include "verify/forms.h"
#include "verify/verify.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>

namespace diatom::cli {

namespace {

using Json = nlohmann::ordered_json;

struct VerifyOptions
{
   std::vector<std::string> files;
   bool list = false, markdown = false, summary = false;
};

void listForms(Context &context)
{
   auto rows = Json::array();
   for (const Form &form : verificationForms())
      rows.push_back({{"form", form.name}, {"asks", form.asks}, {"solver", form.answer ? "yes" : "not yet"}});
   context.printTable(rows);
}

Json numbersJson(const std::vector<double> &values)
{
   // JSON has no infinity.
   auto list = Json::array();
   for (const double value : values)
      list.push_back(std::isfinite(value) ? Json(value) : Json());
   return list.size() == 1 ? list.front() : list;
}

Json toJson(const Finding &finding)
{
   Json row{{"path", finding.path}, {"verdict", verdictText(finding.verdict)}};
   if (!finding.computed.empty())
      row["computed"] = numbersJson(finding.computed);
   if (!finding.computedWord.empty())
      row["computed"] = finding.computedWord;
   if (!finding.reference.empty())
      row["reference"] = numbersJson(finding.reference);
   if (!finding.referenceWord.empty())
      row["reference"] = finding.referenceWord;
   if (!finding.computed.empty()) {
      row["error"] = std::isfinite(finding.error) ? Json(finding.error) : Json();
      row["tolerance"] = finding.tolerance;
      row["measure"] = finding.measure;
   }
   if (!finding.note.empty())
      row["note"] = finding.note;
   return row;
}

Json toJson(const Tally &tally)
{
   return {{"pass", tally.pass},
           {"fail", tally.fail},
           {"not_computed", tally.notComputed},
           {"not_of_this_solver_yet", tally.later}};
}

Json toJson(const CaseReport &report)
{
   Tally tally;
   tally.add(report);
   auto rows = Json::array();
   for (const Finding &finding : report.findings)
      rows.push_back(toJson(finding));
   return {{"id", report.id},           {"form", report.form},    {"file", report.file},
           {"seconds", report.seconds}, {"tally", toJson(tally)}, {"values", std::move(rows)}};
}

std::string text(const std::vector<double> &values, const std::string &word)
{
   if (!word.empty())
      return word;
   std::string out;
   for (const double value : values)
      out += fmt::format("{}{:.6g}", out.empty() ? "" : " ", value);
   return out.empty() ? "-" : out;
}

std::string text(const Tally &tally)
{
   return fmt::format("{} pass, {} FAIL, {} not computed, {} not of this solver yet", tally.pass, tally.fail,
                      tally.notComputed, tally.later);
}

void printCase(const CaseReport &report, bool summary)
{
   Tally tally;
   tally.add(report);
   fmt::print("{} ({}): {}; {:.1f} s\n", report.id, report.form, text(tally), report.seconds);
   for (const Finding &finding : report.findings) {
      if (summary && finding.verdict != Finding::Verdict::fail)
         continue;
      const bool compared = finding.compared();
      if (compared)
         fmt::print("  {}: computed {}, reference {}, error {:.2e} of {:.2e} {}: {}{}\n", finding.path,
                    text(finding.computed, finding.computedWord),
                    text(finding.reference, finding.referenceWord), finding.error, finding.tolerance,
                    finding.measure, verdictText(finding.verdict),
                    finding.note.empty() ? "" : " (" + finding.note + ")");
      else
         fmt::print("  {}: reference {}: {}: {}\n", finding.path,
                    text(finding.reference, finding.referenceWord), verdictText(finding.verdict),
                    finding.note);
   }
}

void print(const std::vector<CaseReport> &reports, const Tally &all, const VerifyOptions &options,
           Context &context)
{
   if (options.markdown) {
      fmt::print("{}", verificationPage(reports));
      return;
   }
   if (context.json) {
      auto cases = Json::array();
      for (const CaseReport &report : reports)
         cases.push_back(toJson(report));
      context.print({{"tally", toJson(all)}, {"cases", std::move(cases)}});
      return;
   }
   for (const CaseReport &report : reports)
      printCase(report, options.summary);
   fmt::print("{} cases: {}\n", reports.size(), text(all));
}

void verify(const VerifyOptions &options, Context &context)
{
   if (options.list)
      return listForms(context);
   std::vector<CaseReport> reports;
   Tally all;
   for (std::size_t i = 0; i < options.files.size(); ++i) {
      context.job().progress(static_cast<double>(i) / static_cast<double>(options.files.size()),
                             options.files[i]);
      const auto one = readCase(options.files[i]);
      if (!one)
         return context.fail(one.error());
      auto report = verifyCase(*one, context.catalogue(), context.job());
      if (!report)
         return context.fail(report.error());
      all.add(*report);
      reports.push_back(*std::move(report));
   }
   print(reports, all, options, context);
   if (all.fail > 0)
      context.exit = kCheckFailed;
}

} // namespace

void addVerify(CLI::App &app, Context &context)
{
   const auto options = std::make_shared<VerifyOptions>();
   CLI::App *command = app.add_subcommand("verify", "Hold the solver against answers found in another way");
   auto *files = command->add_option(
       "CASE", options->files, "Verification cases (docs/verification-cases.md), JSON, - for standard input");
   auto *list = command->add_flag("--list", options->list, "Show the forms of cases that there are");
   files->excludes(list);
   command->add_flag("--markdown", options->markdown, "A page in the manner of a verification manual");
   command->add_flag("--summary", options->summary, "One line for each case, and whatever fails");
   command->footer(
       "Examples:\n  diatom verify resources/verification/*.json\n  diatom verify elastica.json --json\n"
       "  diatom verify --list");
   command->callback([options, &context] {
      if (options->files.empty() && !options->list)
         return context.fail({ErrorCode::usage, "name at least one case, or --list"});
      verify(*options, context);
   });
}

} // namespace diatom::cli
