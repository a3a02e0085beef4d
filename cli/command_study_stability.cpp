// diatom study stability: hard cases against the bounds that they have to keep.
#include "cli/command_study.h"
#include "core/file.h"
#include "study/stability_study.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace diatom::cli {

namespace {

struct StabilityOptions
{
   std::string folder;
   StabilityRequest request;
   bool list = false;
};

Status writeStability(const StabilityStudy &study, const std::filesystem::path &folder)
{
   if (Status made = makeFolder(folder); !made)
      return made;
   if (Status table = writeFileAtomic(folder / "stability.csv", stabilityCsv(study)); !table)
      return table;
   if (Status page = writeFileAtomic(folder / "stability.md", stabilityMarkdown(study)); !page)
      return page;
   return writeFileAtomic(folder / "stability.json", stabilityJson(study).dump(2) + "\n");
}

nlohmann::ordered_json tableOf(const StabilityStudy &study)
{
   auto table = nlohmann::ordered_json::array();
   for (const StabilityRow &row : study.rows) {
      for (const StabilityCheck &check : row.checks)
         table.push_back({{"case", row.id},
                          {"steps", row.steps},
                          {"measure", check.what},
                          {"measured", fmt::format("{:.3g}", check.measured)},
                          {"bound", fmt::format("{:.3g}", check.bound)},
                          {"verdict", check.holds() ? "holds" : "FAILS"}});
      if (!row.failure.empty())
         table.push_back({{"case", row.id},
                          {"steps", row.steps},
                          {"measure", row.failure},
                          {"measured", ""},
                          {"bound", ""},
                          {"verdict", "FAILS"}});
   }
   return table;
}

void run(const StabilityOptions &options, Context &context)
{
   if (options.list) {
      auto names = nlohmann::ordered_json::array();
      for (const auto &[id, scene] : stabilityRows())
         names.push_back({{"case", id}, {"scene", scene}});
      return context.json ? context.print(names) : context.printTable(names);
   }
   const auto found = studyStability(context.catalogue(), options.request, context.job());
   if (!found)
      return context.fail(found.error());
   if (!options.folder.empty())
      if (const Status written = writeStability(*found, options.folder); !written)
         return context.fail(written.error());
   if (context.json)
      context.print(stabilityJson(*found));
   else
      context.printTable(tableOf(*found));
   if (!found->holds())
      context.fail(
          Error{ErrorCode::unstable, "not every hard case keeps its bounds; FAILS marks those that do not"});
}

} // namespace

void addStudyStability(CLI::App &study, Context &context)
{
   const auto options = std::make_shared<StabilityOptions>();
   CLI::App *command = study.add_subcommand(
       "stability", "Hard cases against the bounds on energy, momentum and rest that they keep");
   command->add_option("CASES", options->request.rows, "Which cases; default: all");
   command->add_flag("--list", options->list, "Name the cases");
   command->add_flag("--long", options->request.longForm,
                     "Up to 10^6 steps and 28^3 cells: minutes instead of seconds");
   command->add_option("-o,--output", options->folder, "Folder for stability.csv, .json and .md");
   command->footer("Examples:\n  diatom study stability\n  diatom study stability kick spin --long -o out");
   command->callback([options, &context] { run(*options, context); });
}

} // namespace diatom::cli
