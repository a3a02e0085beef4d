// diatom check: every problem a design has, from its wiring to its assembly.
#include "assembly/chosen_parts.h"
#include "cli/commands.h"
#include "cli/scene_json.h"
#include "scene/problems.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace diatom::cli {

namespace {

void append(std::vector<Problem> &problems, std::vector<Problem> more)
{
   problems.insert(problems.end(), std::make_move_iterator(more.begin()),
                   std::make_move_iterator(more.end()));
}

/// What could not be looked into is said, not passed over.
void appendNotExamined(std::vector<Problem> &problems, const char *what, const Error &error)
{
   problems.push_back({Problem::Severity::warning,
                       "not-examined",
                       fmt::format("{} not examined: {}", what, error.message),
                       {}});
}

void checkParts(const Context::Input &input, Context &context, std::vector<Problem> &problems)
{
   const AssemblySetup &setup = input.opened.design.assembly;
   const auto maker =
       chosenParts(*context.catalogue(), setup, "", input.opened.design.model.lattice.id, context.job());
   if (!maker)
      return appendNotExamined(problems, "parts and their placing were", maker.error());
   const auto parts = (*maker)->decompose(*input.hierarchy, context.job());
   if (!parts) {
      problems.push_back({Problem::Severity::error, "parts-not-formed", parts.error().message, {}});
      return;
   }
   if (!parts->left.empty())
      problems.push_back({Problem::Severity::error, "cells-without-part",
                          fmt::format("no part covers {} cells: {}; change the design or the decomposition",
                                      parts->left.size(), indicesText(parts->left)),
                          parts->left});
   auto plan = planAssembly(*input.hierarchy, *parts, context.job());
   if (!plan)
      return appendNotExamined(problems, "the placing of parts was", plan.error());
   append(problems, std::move(plan->problems));
}

void check(const std::string &file, Context &context)
{
   const auto input = context.open(file);
   if (!input)
      return;
   const Setup &setup = input->opened.design.setup;
   std::vector<Problem> problems = findSetupProblems(*input->hierarchy, setup);
   append(problems, findNetworks(*input->hierarchy, setup, context.job()).problems);
   if (input->hierarchy->cells() > 0) {
      if (const auto bodies = findBodies(*input->hierarchy, context.job())) {
         append(problems, findFloatingBodies(*input->hierarchy, *bodies, setup));
         append(problems, findUnheldBodies(*input->hierarchy, *bodies, setup, context.job()));
      } else {
         appendNotExamined(problems, "loose bodies were", bodies.error());
      }
      if (!context.job().cancelled())
         checkParts(*input, context, problems);
   }
   if (context.job().cancelled())
      return context.fail({ErrorCode::cancelled, "cancelled while checking"});
   if (context.json) {
      context.print(
          {{"errors", std::count_if(problems.begin(), problems.end(),
                                    [](const Problem &p) { return p.severity == Problem::Severity::error; })},
           {"problems", toJson(problems)}});
   } else {
      for (const Problem &problem : problems)
         context.print({{problem.severity == Problem::Severity::error ? "error" : "warning",
                         fmt::format("{}: {}", problem.kind, problem.text)}});
      if (problems.empty())
         context.note("No problems found.");
   }
   if (hasErrors(problems))
      context.exit = kCheckFailed;
}

} // namespace

void addCheck(CLI::App &app, Context &context)
{
   const auto file = std::make_shared<std::string>();
   CLI::App *command =
       app.add_subcommand("check", "Find every problem of a design: wiring, supports, parts, placing");
   command->add_option("FILE", *file, "A design of any readable format, - for standard input")->required();
   command->footer("Ends with 5 when there are errors. Examples:\n  diatom check gripper.diatom\n"
                   "  diatom check gripper.diatom --json");
   command->callback([file, &context] { check(*file, context); });
}

} // namespace diatom::cli
