// diatom-plugin-check: holds a plugin against the contract, each check in a process of its own.
#include "plugin_check/checks.h"
#include "plugin_check/runner.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>

using namespace diatom;
using namespace diatom::check;

namespace {

namespace fs = std::filesystem;

constexpr int kPassed = 0, kWarned = 1, kFailed = 2, kCannotLoad = 3, kUsage = 4;

struct Options
{
   Request request;
   std::vector<std::string> only;
   std::string inProcess;
   bool json = false, list = false, handOver = false;
};

const char *wordOf(Severity severity)
{
   constexpr std::array<const char *, 4> words{"ok", "skipped", "warning", "FAILED"};
   return words[static_cast<std::size_t>(severity)];
}

void print(const Outcome &outcome)
{
   fmt::print("{:<8} {:<24} {:>7.0f} ms  {}\n", wordOf(worst(outcome.findings)), outcome.check->name,
              outcome.seconds * 1e3, outcome.check->promise);
   constexpr std::size_t kMostShown = 8;
   const std::size_t shown = std::min(outcome.findings.size(), kMostShown);
   for (std::size_t i = 0; i < shown; ++i)
      fmt::print("         {}: {}\n", wordOf(outcome.findings[i].severity), outcome.findings[i].text);
   if (shown < outcome.findings.size())
      fmt::print("         and {} more (all of them with --json)\n", outcome.findings.size() - shown);
   std::fflush(stdout);
}

nlohmann::ordered_json jsonOf(const Outcome &outcome)
{
   nlohmann::ordered_json findings = nlohmann::ordered_json::array();
   for (const Finding &finding : outcome.findings)
      findings.push_back({{"severity", wordOf(finding.severity)}, {"text", finding.text}});
   return {{"check", outcome.check->name},
           {"verdict", wordOf(worst(outcome.findings))},
           {"seconds", outcome.seconds},
           {"findings", findings}};
}

bool wanted(const Check &check, const std::vector<std::string> &only)
{
   return only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string &part) {
             return check.name == part || check.name.starts_with(part + ".");
          });
}

/// The checks that fit what the plugin provides and what was asked for.
std::vector<Check> choose(const Manifest &manifest, const std::vector<std::string> &only)
{
   std::vector<Check> chosen;
   for (Check &check : allChecks()) {
      const bool fits = !check.interface ||
                        std::any_of(manifest.provides.begin(), manifest.provides.end(),
                                    [&](const Provided &one) { return one.interface == check.interface; });
      if (fits && wanted(check, only))
         chosen.push_back(std::move(check));
   }
   return chosen;
}

int runOne(const Options &options, Subject subject)
{
   for (const Check &check : allChecks())
      if (check.name == options.inProcess) {
         const auto findings = runHere(check, std::move(subject));
         if (options.handOver)
            handOver(findings);
         else
            print({&check, findings, 0});
         return worst(findings) == Severity::failure && !options.handOver ? kFailed : kPassed;
      }
   fmt::print(stderr, "there is no check {}; --list names them\n", options.inProcess);
   return kUsage;
}

std::string replayOf(const Options &options, const std::string &check)
{
   std::string line =
       fmt::format("diatom-plugin-check {} --seed {}", options.request.folder.string(), options.request.seed);
   for (const fs::path &design : options.request.designs)
      line += " --design " + design.string();
   return line + " --only " + check;
}

int runAll(const Options &options, const Subject &subject)
{
   const std::vector<Check> checks = choose(subject.manifest, options.only);
   if (checks.empty()) {
      fmt::print(stderr, "no check of that name fits this plugin; --list names them\n");
      return kUsage;
   }
   if (!options.json)
      fmt::print("{} {}, seed {}\n", subject.manifest.id, subject.manifest.version, options.request.seed);
   nlohmann::ordered_json rows = nlohmann::ordered_json::array();
   std::array<int, 4> counts{};
   std::string firstFailed;
   for (const Check &check : checks) {
      const Outcome outcome = runApart(check, options.request);
      const Severity severity = worst(outcome.findings);
      ++counts[static_cast<std::size_t>(severity)];
      if (severity == Severity::failure && firstFailed.empty())
         firstFailed = check.name;
      if (options.json)
         rows.push_back(jsonOf(outcome));
      else
         print(outcome);
      if (severity == Severity::failure && check.name == kLoads)
         break; // all others would say the same
   }
   const auto count = [&](Severity severity) { return counts[static_cast<std::size_t>(severity)]; };
   if (options.json)
      fmt::print("{}\n", nlohmann::ordered_json({{"plugin", subject.manifest.id},
                                                 {"version", subject.manifest.version},
                                                 {"seed", options.request.seed},
                                                 {"passed", count(Severity::pass)},
                                                 {"skipped", count(Severity::skipped)},
                                                 {"warnings", count(Severity::warning)},
                                                 {"failures", count(Severity::failure)},
                                                 {"checks", rows}})
                             .dump(1));
   else
      fmt::print("{} passed, {} skipped, {} with warnings, {} failed\n", count(Severity::pass),
                 count(Severity::skipped), count(Severity::warning), count(Severity::failure));
   if (!firstFailed.empty() && !options.json)
      fmt::print("the same again: {}\nin a debugger: --in-process {} instead of --only\n",
                 replayOf(options, firstFailed), firstFailed);
   if (firstFailed == kLoads)
      return kCannotLoad;
   return count(Severity::failure) > 0 ? kFailed : count(Severity::warning) > 0 ? kWarned : kPassed;
}

} // namespace

int main(int argc, char **argv)
{
   Options options;
   options.request.seed = std::random_device{}();
   CLI::App app{"Checks that a plugin of Diatom keeps the contract: each check in a process of its own.",
                "diatom-plugin-check"};
   app.set_version_flag("--version", DIATOM_VERSION);
   app.add_option("FOLDER", options.request.folder, "The plugin's folder, with plugin.json and the library");
   app.add_option("--seed", options.request.seed,
                  "Of the random inputs; printed, so that a run can be repeated");
   app.add_option("--only", options.only, "Checks to run, by name (lattice.contacts) or group (lattice)");
   app.add_option("--in-process", options.inProcess, "Run this one check in this process, for a debugger");
   app.add_option("--design", options.request.designs,
                  "A design to try the plugin on; may be given several times");
   app.add_option("--seconds", options.request.seconds, "After which a check counts as hanging")
       ->check(CLI::PositiveNumber);
   app.add_flag("--json", options.json, "Print one JSON value");
   app.add_flag("--list", options.list, "List the checks and what each promises");
   app.add_flag("--hand-over", options.handOver)->group(""); // the program to itself
   app.footer(
       "Exit codes: 0 all passed, 1 with warnings, 2 failures, 3 the plugin cannot be loaded, 4 usage.");
   try {
      app.parse(argc, argv);
   } catch (const CLI::ParseError &error) {
      return app.exit(error) == 0 ? kPassed : kUsage;
   }
   if (options.list) {
      for (const Check &check : allChecks())
         fmt::print("{:<24} {}\n", check.name, check.promise);
      return kPassed;
   }
   if (options.request.folder.empty()) {
      fmt::print(stderr, "name the plugin's folder: diatom-plugin-check FOLDER (--help tells more)\n");
      return kUsage;
   }
   auto subject = openSubject(options.request.folder, options.request.seed, options.request.designs);
   if (!subject) {
      fmt::print(stderr, "{}\n", subject.error().message);
      return kCannotLoad;
   }
   if (!options.inProcess.empty())
      return runOne(options, *std::move(subject));
   return runAll(options, *subject);
}
