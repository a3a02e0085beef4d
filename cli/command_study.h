// The sub-commands of `diatom study`, one file each; addStudy() in command_study.cpp registers them.
#pragma once

#include "cli/cli.h"

namespace diatom::cli {

void addStudyAccuracy(CLI::App &study, Context &context);
void addStudyEffects(CLI::App &study, Context &context);
void addStudyStability(CLI::App &study, Context &context);

} // namespace diatom::cli
