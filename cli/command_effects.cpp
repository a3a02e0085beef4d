// diatom effects: which physics a design calls for, why, and what each costs.
#include "cli/commands.h"
#include "cli/scene_json.h"
#include "study/effects_study.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace diatom::cli {

namespace {

struct Options
{
   std::string file, effects;
   bool withoutCost = false;
};

/// Enough turns for the tenth of a nanosecond that is shown, in some tenths of a second an effect.
constexpr EffectsRequest kBrief{9, 5e-3};

/// What each effect adds to a step, to 0.1 ns: those that are off nothing (`diatom study effects` proves it),
/// those that are on what is measured here. Unknown where nothing moves.
Status addCosts(const Design &design, std::vector<Effect> &effects, Context &context)
{
   const auto study = studyEffectsOf(context.catalogue(), design, kBrief, context.job());
   if (!study)
      return study.error();
   for (Effect &effect : effects)
      if (!effect.on)
         effect.costNs = 0;
   for (const EffectRow &row : study->rows) {
      const auto effect = std::find_if(effects.begin(), effects.end(),
                                       [&](const Effect &one) { return one.name == row.effect; });
      if (effect != effects.end() && row.cost())
         effect->costNs = std::max(0.0, std::round(10 * *row.cost()) / 10);
      else if (!row.note.empty())
         context.note("what " + row.effect + " costs is not known: " + row.note);
   }
   return {};
}

void showEffects(const Options &options, Context &context)
{
   const auto input = context.open(options.file);
   if (!input)
      return;
   Design design = input->opened.design;
   if (!options.effects.empty())
      if (const Status applied = applyEffects(options.effects, design.setup); !applied)
         return context.fail(applied.error());
   const Networks networks = findNetworks(*input->hierarchy, design.setup, context.job());
   auto effects = planEffects(*input->hierarchy, design.setup, networks);
   if (!options.withoutCost)
      if (const Status added = addCosts(design, effects, context); !added)
         context.note("what effects cost is not known: " + added.error().message);
   if (context.job().cancelled())
      return context.fail({ErrorCode::cancelled, "cancelled while looking at effects"});
   context.printTable(toJson(effects));
}

} // namespace

void addEffects(CLI::App &app, Context &context)
{
   const auto options = std::make_shared<Options>();
   CLI::App *command = app.add_subcommand(
       "effects", "Show which physical effects a design calls for, why, and what each costs");
   command->add_option("FILE", options->file, "A design of any readable format, - for standard input")
       ->required();
   command->add_option("--effects", options->effects, "auto, or +NAME,-NAME to switch effects on and off");
   command->add_flag("--no-cost", options->withoutCost,
                     "Do not measure what each adds to a step (ns per cell-step)");
   command->footer("Examples:\n  diatom effects gripper.diatom\n  diatom effects gripper.diatom "
                   "--effects=-damping --json");
   command->callback([options, &context] { showEffects(*options, context); });
}

} // namespace diatom::cli
