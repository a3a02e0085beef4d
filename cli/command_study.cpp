// diatom study: what accuracy costs and what effects cost, as tables, JSON and plots.
#include "cli/accuracy_option.h"
#include "cli/commands.h"
#include "cli/scene_json.h"
#include "core/text.h"
#include "study/accuracy_report.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace diatom::cli {

namespace {

struct AccuracyOptions
{
   std::string file, folder, quantity, tolerance = "1%";
   std::vector<std::string> settings;
   AccuracyRequest request;
};

std::string settingOf(const AccuracyStudy &study, int k)
{
   const AccuracyRow &row = study.rows[static_cast<std::size_t>(k)];
   std::string text = row.analysis == "dynamics"
                          ? fmt::format("{}, step {} s", row.setting, numberText(row.step))
                          : row.analysis;
   if (row.resolution > 1)
      text += fmt::format(", resolution {}", row.resolution);
   return fmt::format("{}: error {}, {} s", text, row.error ? fmt::format("{:.2g}", *row.error) : "unknown",
                      fmt::format("{:.3g}", row.seconds));
}

nlohmann::ordered_json accuracyLines(const AccuracyStudy &study, const std::string &folder)
{
   const AccuracyReference &reference = study.reference;
   nlohmann::ordered_json lines{{"quantity", study.quantity.text()}, {"simulated_s", study.until}};
   lines["reference"] = fmt::format("{}: {}", reference.exact ? "exact" : "converged run", reference.source);
   if (!reference.exact)
      lines["reference_error"] = reference.ownError
                                     ? fmt::format("{:.1e}, estimated; observed order {:.1f}",
                                                   *reference.ownError, reference.order.value_or(0))
                                     : "unknown: " + reference.doubt;
   lines["careful"] = study.careful < 0 ? "not run" : settingOf(study, study.careful);
   lines["cheapest"] = study.cheapest < 0 ? "none within the tolerance" : settingOf(study, study.cheapest);
   if (const auto gain = study.gain())
      lines["times_faster"] = fmt::format("{:.1f}", *gain);
   lines["notes"] = study.notes;
   lines["folder"] = folder;
   return lines;
}

void studyAccuracyOf(const AccuracyOptions &options, Context &context)
{
   AccuracyRequest request = options.request;
   if (!options.quantity.empty()) {
      auto quantity = parseQuantity(options.quantity);
      if (!quantity)
         return context.fail(quantity.error());
      request.quantity = *std::move(quantity);
   }
   const auto tolerance = parseAccuracy(options.tolerance);
   if (!tolerance)
      return context.fail(tolerance.error());
   request.tolerance = *tolerance;
   auto opened = openDesign(options.file, context.job());
   if (!opened)
      return context.fail(opened.error());
   for (const std::string &text : opened->notes)
      context.note(text);
   for (const std::string &setting : options.settings)
      if (const Status set = applySetting(setting, opened->design); !set)
         return context.fail(set.error());
   auto study = studyAccuracy(context.catalogue(), opened->design, request, context.job());
   if (!study)
      return context.fail(study.error());
   if (const Status written = writeAccuracy(*study, options.folder); !written)
      return context.fail(written.error());
   context.print(context.json ? accuracyJson(*study) : accuracyLines(*study, options.folder));
}

void addAccuracy(CLI::App &study, Context &context)
{
   const auto options = std::make_shared<AccuracyOptions>();
   AccuracyRequest &request = options->request;
   CLI::App *command = study.add_subcommand(
       "accuracy", "Error and time over integrators, steps, precisions, gradients, beams and resolutions");
   command->add_option("FILE", options->file, "A design of any readable format, - for standard input")
       ->required();
   command->add_option("-o,--output", options->folder, "Folder for accuracy.csv, .json, .svg and .png")
       ->required();
   command->add_option("--quantity", options->quantity,
                       "X,Y,Z:CHANNEL, with @SECONDS, @rest or @frequency; default: the design's reference, "
                       "else the cell that moves most, over the whole run");
   command->add_option("--until", request.until, "Time to simulate, s; default: out and back once")
       ->check(CLI::PositiveNumber);
   command->add_option("--tolerance", options->tolerance, "Accuracy asked for, as 1% or 0.01");
   command->add_option("--budget", request.budget, "Wall time the study may take, s")
       ->check(CLI::PositiveNumber);
   command->add_option("--repeats", request.repeats, "Timings of each setting; their median counts")
       ->check(CLI::PositiveNumber);
   command
       ->add_option("--resolution", request.resolutions,
                    "Cells along an edge that each cell is cut into, as 1,2,3")
       ->delimiter(',')
       ->check(CLI::PositiveNumber);
   command->add_option("--set", options->settings, "Change PATH=VALUE for this study, e.g. drag=40; repeats")
       ->allow_extra_args(false);
   command->footer(
       "Examples:\n  diatom study accuracy beam.diatom -o out --quantity 0,13,0:z@0.1\n"
       "  diatom study accuracy flexure.diatom -o out --quantity 8,6,0:y@rest --resolution 1,2,3");
   command->callback([options, &context] { studyAccuracyOf(*options, context); });
}

} // namespace

void addStudy(CLI::App &app, Context &context)
{
   CLI::App *study = app.add_subcommand("study", "Measure what accuracy and effects cost");
   study->require_subcommand(1);
   addAccuracy(*study, context);
}

} // namespace diatom::cli
