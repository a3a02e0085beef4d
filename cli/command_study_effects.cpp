// diatom study effects: what each effect costs in a step, and that an absent one costs nothing.
#include "cli/command_study.h"
#include "cli/number_checks.h"
#include "cli/scene_json.h"
#include "core/file.h"
#include "study/effects_study.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>

namespace diatom::cli {

namespace {

struct EffectsOptions
{
   std::string file, folder;
   EffectsRequest request;
};

Status writeEffects(const EffectsStudy &study, const std::filesystem::path &folder)
{
   if (Status made = makeFolder(folder); !made)
      return made;
   if (Status table = writeFileAtomic(folder / "effects.csv", effectsCsv(study)); !table)
      return table;
   return writeFileAtomic(folder / "effects.json", effectsJson(study).dump(2) + "\n");
}

/// "1.003, same bits".
std::string timingText(const std::optional<EffectTiming> &timing)
{
   return timing ? fmt::format("{:.3f}, {} bits", timing->ratio, timing->sameBits ? "same" : "other") : "-";
}

nlohmann::ordered_json tableOf(const EffectsStudy &study)
{
   auto table = nlohmann::ordered_json::array();
   const auto number = [](const std::optional<double> &value) {
      return value ? fmt::format("{:.2f}", *value) : std::string("-");
   };
   for (const EffectRow &row : study.rows)
      table.push_back({{"effect", row.effect},
                       {"ns without", row.cells > 0 ? fmt::format("{:.2f}", row.without) : "-"},
                       {"ns with", number(row.calledFor)},
                       {"cost", number(row.cost())},
                       {"ruled out", timingText(row.ruledOut)},
                       {"on for nothing", timingText(row.forcedOn)},
                       {"scene", row.note.empty() ? row.scene : row.note}});
   return table;
}

Result<EffectsStudy> study(const EffectsOptions &options, Context &context)
{
   if (options.file.empty())
      return studyEffects(context.catalogue(), options.request, context.job());
   auto opened = openDesign(options.file, context.job());
   if (!opened)
      return opened.error();
   for (const std::string &text : opened->notes)
      context.note(text);
   return studyEffectsOf(context.catalogue(), opened->design, options.request, context.job());
}

void run(const EffectsOptions &options, Context &context)
{
   const auto found = study(options, context);
   if (!found)
      return context.fail(found.error());
   if (!options.folder.empty())
      if (const Status written = writeEffects(*found, options.folder); !written)
         return context.fail(written.error());
   if (context.json)
      context.print(effectsJson(*found));
   else
      context.printTable(tableOf(*found));
}

} // namespace

void addStudyEffects(CLI::App &study, Context &context)
{
   const auto options = std::make_shared<EffectsOptions>();
   CLI::App *command = study.add_subcommand(
       "effects", "What each effect costs in a step, and that one a scene does not call for costs nothing");
   command->add_option("FILE", options->file,
                       "A design, whose own effects are switched off in turn; default: blocks that have or "
                       "lack one effect each");
   command->add_option("-o,--output", options->folder, "Folder for effects.csv and effects.json");
   command->add_option("--turns", options->request.turns, "Timings of each scene, in turns")
       ->check(kPositive);
   command->add_option("--turn-seconds", options->request.turnSeconds, "Length of each, s")->check(kPositive);
   command->footer("Examples:\n  diatom study effects -o out\n  diatom study effects walker.diatom");
   command->callback([options, &context] { run(*options, context); });
}

} // namespace diatom::cli
