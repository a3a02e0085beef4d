#include "study/accuracy_choice.h"

#include "core/clock.h"
#include "core/text.h"
#include "study/settings.h"
#include "study/step_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace diatom {

namespace {

constexpr std::array<std::string_view, 2> kSearched{"integrator", "precision"};
/// Estimates from three step lengths carry an error of their own, some ten to thirty percent of them at the
/// coarsest steps: what is aimed at.
constexpr double kAim = 0.7;
constexpr double kLeastBudget = 1; // s
/// Of the time of a run, so that a probe sees a sixteenth of it at three step lengths.
constexpr double kBudgetShare = 0.55;
constexpr double kPilot = 0.1; // s, for timing a step

struct Search
{
   const Subject &subject;
   const ChoiceRequest &request;
   const Job &job;
   AccuracyChoice choice;
   double best;                 // s
   std::optional<Error> failed; // the first

   /// Time the run takes at least with these settings: at the longest stable step; 0 without such a limit.
   Result<double> leastSeconds(const Values &values) const;
   Result<SettingOption> look(const Values &values);
   Status probe(SettingOption &candidate, double least);
   void fail(SettingOption &candidate, const Error &error);
};

void Search::fail(SettingOption &candidate, const Error &error)
{
   candidate.step = 0;
   candidate.note = error.message;
   if (!failed)
      failed = error;
}

Result<double> Search::leastSeconds(const Values &values) const
{
   const auto limit = findStepLimit(subject, values, job);
   if (!limit)
      return limit.error();
   if (!(limit->stableStep > 0))
      return 0.0;
   const double step = kCoarsestStep * limit->stableStep;
   const auto time = timeStep(subject, values, step, request.until, kPilot, job);
   if (!time)
      return time.error();
   return *time * request.until / step;
}

Status Search::probe(SettingOption &candidate, double least)
{
   ProbeRequest asked;
   asked.until = request.until;
   asked.quantity = choice.quantity.channel.empty() ? request.quantity : std::optional(choice.quantity);
   asked.budget = std::min(std::max(kLeastBudget, kBudgetShare * least), request.budget);
   asked.values = candidate.values;
   const auto probe = probeAccuracy(subject, asked, job);
   if (!probe)
      return probe.error();
   choice.quantity = probe->quantity;
   const auto step = stepFor(*probe, kAim * request.error);
   if (!step) {
      candidate.note = probe->convergence.doubt();
      if (candidate.note.empty())
         candidate.note = "far shorter steps than those tried would be needed";
      return {};
   }
   const PresetEstimate estimate = estimateAt(*probe, candidate.setting, *step);
   candidate.step = *step;
   candidate.error = estimate.error;
   candidate.withinError = probe->convergence.relativeErrorAt(*step / probe->step).value_or(0);
   candidate.window = probe->window;
   // The time of a step may depend on its length, where each is solved by iteration.
   const auto time = timeStep(subject, candidate.values, *step, request.until, kPilot, job);
   if (!time)
      return time.error();
   const double steps = std::ceil(request.until / *step * (1 - 1e-12));
   candidate.seconds = {
       steps * *time, Knowledge::predicted,
       fmt::format("{} steps of {} us as measured", fixedText(steps, 0), fixedText(1e6 * *time, 1))};
   return {};
}

Result<SettingOption> Search::look(const Values &values)
{
   SettingOption candidate;
   candidate.values = values;
   const auto least = leastSeconds(values);
   if (!least && least.error().code == ErrorCode::cancelled)
      return least.error();
   if (!least) {
      fail(candidate, least.error());
      return candidate;
   }
   if (*least >= best) {
      candidate.note =
          fmt::format("takes {} s even at its longest stable step", fixedText(*least, *least < 1 ? 3 : 1));
      return candidate;
   }
   if (const Status probed = probe(candidate, *least); !probed) {
      if (probed.error().code == ErrorCode::cancelled)
         return probed.error();
      fail(candidate, probed.error());
   }
   if (candidate.step > 0)
      best = std::min(best, candidate.seconds.value);
   return candidate;
}

std::string whyText(const AccuracyChoice &choice)
{
   const SettingOption &best = choice.best();
   const auto inTheRunning = std::count_if(choice.candidates.begin(), choice.candidates.end(),
                                           [](const SettingOption &one) { return one.step > 0; });
   std::string text = fmt::format("{} is the cheapest of {} settings, {} of which {} {} %", best.setting,
                                  choice.candidates.size(), inTheRunning,
                                  inTheRunning == 1 ? "meets" : "meet", numberText(100 * choice.error));
   if (best.error.how == Knowledge::unknown)
      text += fmt::format("; that is known of the first {} s only", numberText(best.window));
   return text;
}

} // namespace

Result<AccuracyChoice> chooseForAccuracy(const Subject &subject, const ChoiceRequest &request, const Job &job)
{
   const auto start = Clock::now();
   if (!(request.error > 0) || !(request.until > 0))
      return Error{ErrorCode::usage, "the accuracy and the length of the run must be above 0"};
   Search search{subject, request, job, {}, std::numeric_limits<double>::infinity(), std::nullopt};
   AccuracyChoice &choice = search.choice;
   choice.error = request.error;
   Values inUse = subject.setup.solverValues;
   for (const auto &[name, value] : request.fixed)
      inUse[name] = value;
   auto choices = solverChoices(*subject.catalogue, subject.setup.solver, inUse, kSearched);
   for (Choice &one : choices)
      if (request.fixed.contains(one.name))
         one.choices.resize(1);
   std::string doubt;
   for (Values values : combinations(choices)) {
      const std::string setting = settingText(choices, values);
      values.insert(request.fixed.begin(), request.fixed.end());
      auto candidate = search.look(values);
      if (!candidate)
         return candidate.error();
      candidate->setting = setting;
      if (candidate->step <= 0 && doubt.empty())
         doubt = setting + ": " + candidate->note;
      choice.candidates.push_back(*std::move(candidate));
   }
   if (!std::isfinite(search.best) && search.failed)
      return *search.failed;
   if (!std::isfinite(search.best))
      return Error{ErrorCode::invalid,
                   fmt::format("no setting can be told to meet {} %; {}; choose a step by hand",
                               numberText(100 * request.error), doubt)};
   const auto cost = [](const SettingOption &one) {
      return one.step > 0 ? one.seconds.value : std::numeric_limits<double>::infinity();
   };
   const auto best =
       std::min_element(choice.candidates.begin(), choice.candidates.end(),
                        [&](const SettingOption &a, const SettingOption &b) { return cost(a) < cost(b); });
   choice.picked = static_cast<std::size_t>(best - choice.candidates.begin());
   choice.why = whyText(choice);
   choice.probeSeconds = secondsSince(start);
   return choice;
}

} // namespace diatom
