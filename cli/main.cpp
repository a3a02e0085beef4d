// diatom: the headless program. Its commands are the table below; the words they share are in cli.h.
#include "cli/commands.h"
#include "cli/number_checks.h"

#include <CLI/CLI.hpp>

using namespace diatom::cli;

namespace {

constexpr AddCommand kCommands[] = {
    addInfo,  addCheck,    addConvert, addDo,      addExport,   addPlan,   addRender,  addSimulate,
    addSolve, addModes,    addEffects, addCircuit, addPipeline, addPlugin, addPlugins, addLattices,
    addParts, addMachines, addSolvers, addBench,   addStudy,    addVerify,
};

} // namespace

int main(int argc, char **argv)
{
   Context context;
   CLI::App app{"Design, simulate and assemble digital materials.", "diatom"};
   app.set_version_flag("--version", DIATOM_VERSION);
   app.require_subcommand(1);
   app.fallthrough(); // common options may also follow the sub-command
   app.add_flag("--json", context.json, "Print one JSON value on standard output");
   app.add_option("--threads", context.threads, "Threads to use; 0 = all. Results do not depend on it")
       ->check(kNonNegative);
   app.add_option("--progress", context.progress, "Progress on standard error")
       ->check(CLI::IsMember({"auto", "line", "json", "none"}));
   app.add_flag("--isolate", context.isolate,
                "Run all solvers, not only those from outside, in a process of their own");
   app.add_option("--plugins", context.pluginFolders, "Folder to look for plugins in, before the usual ones");
   app.footer(
       "Exit codes: 0 done, 1 failed, 2 usage, 3 input unreadable, 4 cannot write, 5 check found errors,\n"
       "6 simulation unstable, 7 time limit, 130 interrupted.");
   for (const AddCommand add : kCommands)
      add(app, context);
   try {
      app.parse(argc, argv);
   } catch (const CLI::ParseError &error) {
      const int code = app.exit(error);
      return code == 0 ? kDone : kUsage;
   }
   return context.exit;
}
