// The commands of the command line, one file each.
#pragma once

#include "cli/cli.h"

namespace diatom::cli {

void addInfo(CLI::App &app, Context &context);
void addPlugin(CLI::App &app, Context &context);
void addPlugins(CLI::App &app, Context &context);
void addLattices(CLI::App &app, Context &context);
void addParts(CLI::App &app, Context &context);
void addMachines(CLI::App &app, Context &context);
void addSolvers(CLI::App &app, Context &context);
void addConvert(CLI::App &app, Context &context);
void addExport(CLI::App &app, Context &context);
void addPlan(CLI::App &app, Context &context);
void addSimulate(CLI::App &app, Context &context);
void addSolve(CLI::App &app, Context &context);
void addModes(CLI::App &app, Context &context);
void addCircuit(CLI::App &app, Context &context);
void addEffects(CLI::App &app, Context &context);
void addCheck(CLI::App &app, Context &context);
void addPipeline(CLI::App &app, Context &context);
void addRender(CLI::App &app, Context &context);
void addDo(CLI::App &app, Context &context);
void addBench(CLI::App &app, Context &context);
void addStudy(CLI::App &app, Context &context);
void addVerify(CLI::App &app, Context &context);

} // namespace diatom::cli
