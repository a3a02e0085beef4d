// diatom study accuracy: error and time over settings, steps and resolutions, as a table, JSON and plots.
#include "cli/accuracy_option.h"
#include "cli/command_study.h"
#include "cli/number_checks.h"
#include "cli/scene_json.h"
#include "core/text.h"
#include "study/accuracy_report.h"
#include "study/accuracy_samples.h"
#include "study/still_trial.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace diatom::cli {

namespace {

struct AccuracyOptions
{
   std::string file, folder, quantity, tolerance = "1%";
   std::vector<std::string> settings, samples, models;
   AccuracyRequest request;
};

std::string settingOf(const AccuracyStudy &study, int k)
{
   const AccuracyRow &row = study.rows[static_cast<std::size_t>(k)];
   std::string text = row.step > 0
                          ? fmt::format("{}, step {} s", row.setting, fmt::format("{:.3g}", row.step))
                          : row.setting;
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

/// What the options ask for, on top of what a sample asks.
Result<AccuracyRequest> requestOf(const AccuracyOptions &options, AccuracyRequest request)
{
   if (!options.quantity.empty()) {
      auto quantity = parseQuantity(options.quantity);
      if (!quantity)
         return quantity.error();
      request.quantity = *std::move(quantity);
   }
   const auto tolerance = parseAccuracy(options.tolerance);
   if (!tolerance)
      return tolerance.error();
   request.tolerance = *tolerance;
   request.budget = options.request.budget;
   request.repeats = options.request.repeats;
   if (options.request.until > 0)
      request.until = options.request.until;
   if (!options.request.resolutions.empty())
      request.resolutions = options.request.resolutions;
   for (const std::string &model : options.models)
      for (const CellModel one : {CellModel::bond, CellModel::block, CellModel::solid})
         if (model == cellModelName(one))
            request.models.push_back(one);
   return request;
}

Result<AccuracyStudy> study(const Design &design, const AccuracyOptions &options,
                            const AccuracyRequest &asked, const std::filesystem::path &folder,
                            Context &context)
{
   const auto request = requestOf(options, asked);
   if (!request)
      return request.error();
   auto study = studyAccuracy(context.catalogue(), design, *request, context.job());
   if (!study)
      return study;
   if (const Status written = writeAccuracy(*study, folder); !written)
      return written.error();
   return study;
}

void studyFile(const AccuracyOptions &options, Context &context)
{
   auto opened = openDesign(options.file, context.job());
   if (!opened)
      return context.fail(opened.error());
   for (const std::string &text : opened->notes)
      context.note(text);
   for (const std::string &setting : options.settings)
      if (const Status set = applySetting(setting, opened->design); !set)
         return context.fail(set.error());
   AccuracyRequest request;
   const auto found = study(opened->design, options, request, options.folder, context);
   if (!found)
      return context.fail(found.error());
   context.print(context.json ? accuracyJson(*found) : accuracyLines(*found, options.folder));
}

/// One line of the table of all samples.
nlohmann::ordered_json sampleLine(const AccuracySample &sample, const AccuracyStudy &study)
{
   const auto row = [&](int k) { return k < 0 ? std::string("none") : settingOf(study, k); };
   const auto gain = study.gain();
   return {{"sample", sample.id},
           {"quantity", study.quantity.text()},
           {"reference", study.reference.source},
           {"cheapest", row(study.cheapest)},
           {"careful", row(study.careful)},
           {"times_faster", gain ? fmt::format("{:.3g}", *gain) : "unknown"}};
}

/// Of the samples asked for, one that there is not.
std::optional<Error> unknownSample(const std::vector<AccuracySample> &all,
                                   const std::vector<std::string> &asked)
{
   std::string known;
   for (const AccuracySample &sample : all)
      known += (known.empty() ? "" : ", ") + sample.id;
   for (const std::string &id : asked)
      if (std::none_of(all.begin(), all.end(), [&](const AccuracySample &sample) { return sample.id == id; }))
         return Error{ErrorCode::usage, fmt::format("--sample: there is no \"{}\", but {}", id, known)};
   return {};
}

void studySamples(const AccuracyOptions &options, Context &context)
{
   const std::vector<AccuracySample> samples = accuracySamples();
   if (const auto unknown = unknownSample(samples, options.samples))
      return context.fail(*unknown);
   auto table = nlohmann::ordered_json::array();
   for (const AccuracySample &sample : samples) {
      if (!options.samples.empty() &&
          std::find(options.samples.begin(), options.samples.end(), sample.id) == options.samples.end())
         continue;
      context.note(sample.what);
      const auto found = study(sample.design, options, sample.request,
                               std::filesystem::path(options.folder) / sample.id, context);
      if (!found)
         return context.fail(found.error());
      for (const std::string &note : found->notes)
         context.note(sample.id + ": " + note);
      table.push_back(sampleLine(sample, *found));
   }
   context.printTable(table);
}

} // namespace

void addStudyAccuracy(CLI::App &study, Context &context)
{
   const auto options = std::make_shared<AccuracyOptions>();
   AccuracyRequest &request = options->request;
   request.resolutions.clear();
   CLI::App *command = study.add_subcommand(
       "accuracy", "Error and time over integrators, steps, precisions, gradients, beams and resolutions");
   command->add_option("FILE", options->file,
                       "A design of any readable format, - for standard input; default: the samples");
   command->add_option("--sample", options->samples,
                       "Only this sample: sag, elastica, frequency, stride, flexure, stiff-flexure");
   command
       ->add_option("--models", options->models,
                    "Cell models to try beside the design's own where nothing moves, as block,solid")
       ->delimiter(',')
       ->check(CLI::IsMember({"bond", "block", "solid"}));
   command->add_option("-o,--output", options->folder, "Folder for accuracy.csv, .json, .svg and .png")
       ->required();
   command->add_option("--quantity", options->quantity,
                       "X,Y,Z:CHANNEL, with @SECONDS, @rest or @frequency; default: the design's reference, "
                       "else the cell that moves most, over the whole run");
   command->add_option("--until", request.until, "Time to simulate, s; default: out and back once")
       ->check(kPositive);
   command->add_option("--tolerance", options->tolerance, "Accuracy asked for, as 1% or 0.01");
   command->add_option("--budget", request.budget, "Wall time the study may take, s")->check(kPositive);
   command->add_option("--repeats", request.repeats, "Timings of each setting; their median counts")
       ->check(kPositive);
   command
       ->add_option("--resolution", request.resolutions,
                    "Cells along an edge that each cell is cut into, as 1,2,3")
       ->delimiter(',')
       ->check(kPositive);
   command->add_option("--set", options->settings, "Change PATH=VALUE for this study, e.g. drag=40; repeats")
       ->allow_extra_args(false);
   command->footer(
       "Examples:\n  diatom study accuracy beam.diatom -o out --quantity 0,13,0:z@0.1\n"
       "  diatom study accuracy flexure.diatom -o out --quantity 8,6,0:y@rest --resolution 1,2,3");
   command->callback([options, &context] {
      options->file.empty() ? studySamples(*options, context) : studyFile(*options, context);
   });
}

} // namespace diatom::cli
