// diatom effects: which physics a design calls for, and why.
#include "cli/commands.h"
#include "cli/scene_json.h"

#include <CLI/CLI.hpp>

namespace diatom::cli {

namespace {

void showEffects(const std::string &file, const std::string &forced, Context &context)
{
   const auto input = context.open(file);
   if (!input)
      return;
   Setup setup = input->opened.design.setup;
   if (!forced.empty())
      if (const Status applied = applyEffects(forced, setup); !applied)
         return context.fail(applied.error());
   const Networks networks = findNetworks(*input->hierarchy, setup, context.job());
   const auto effects = planEffects(*input->hierarchy, setup, networks);
   if (context.job().cancelled())
      return context.fail({ErrorCode::cancelled, "cancelled while planning effects"});
   context.printTable(toJson(effects));
}

} // namespace

void addEffects(CLI::App &app, Context &context)
{
   struct Options
   {
      std::string file, effects;
   };
   const auto options = std::make_shared<Options>();
   CLI::App *command =
       app.add_subcommand("effects", "Show which physical effects a design calls for, and why");
   command->add_option("FILE", options->file, "A design of any readable format, - for standard input")
       ->required();
   command->add_option("--effects", options->effects, "auto, or +NAME,-NAME to switch effects on and off");
   command->footer("Examples:\n  diatom effects gripper.diatom\n  diatom effects gripper.diatom "
                   "--effects=-damping --json");
   command->callback([options, &context] { showEffects(options->file, options->effects, context); });
}

} // namespace diatom::cli
