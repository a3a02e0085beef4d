// diatom study: what accuracy, effects and hard cases cost, measured.
#include "cli/command_study.h"
#include "cli/commands.h"

#include <CLI/CLI.hpp>

namespace diatom::cli {

void addStudy(CLI::App &app, Context &context)
{
   CLI::App *study = app.add_subcommand("study", "Measure what a design or the solver itself is good for");
   study->require_subcommand(1);
   addStudyAccuracy(*study, context);
   addStudyEffects(*study, context);
   addStudyStability(*study, context);
}

} // namespace diatom::cli
