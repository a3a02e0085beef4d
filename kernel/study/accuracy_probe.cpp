#include "study/accuracy_probe.h"

#include "core/clock.h"
#include "core/text.h"
#include "study/step_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace diatom {

namespace {

constexpr std::int64_t kWindowSamples = 32;
constexpr std::int64_t kFewestSteps = 8; // in the window at the coarsest step: fewer show no motion
constexpr double kPilotShare = 0.1;      // of the budget, for timing a step
constexpr double kRunsShare = 0.85;      // of the budget, for the runs
/// A run this many times the window is as far as a growth seen within the window is carried on.
constexpr double kFarthest = 16;
/// Of the coarsest step: a law seen over a factor of four is not carried on further than this.
constexpr double kFinest = 1.0 / 256;
/// Phase errors grow as time, those of a motion under way as its square; anything faster is chaos.
constexpr double kFastestGrowth = 3;

Convergence judgeRuns(const Quantity &quantity, const std::array<TrialRun, 3> &runs, double until)
{
   const History &coarse = runs[0].curve, &middle = runs[1].curve, &fine = runs[2].curve;
   if (quantity.when == Quantity::When::atTime && until >= fine.time.back())
      return convergenceOf(coarse.value.back(), middle.value.back(), fine.value.back());
   if (quantity.when != Quantity::When::frequency)
      return convergenceOf(coarse, middle, fine, until);
   const auto a = historyFrequency(coarse), b = historyFrequency(middle), c = historyFrequency(fine);
   return a && b && c ? convergenceOf(*a, *b, *c) : Convergence{};
}

/// Growth of the relative error with the time simulated, from the first half of the window to the whole.
std::optional<double> growthOf(const Quantity &quantity, const std::array<TrialRun, 3> &runs, double window)
{
   if (quantity.when == Quantity::When::frequency)
      return 0.0; // an error of frequency belongs to the step, not to the length of the run
   const Convergence half = convergenceOf(runs[0].curve, runs[1].curve, runs[2].curve, window / 2);
   const Convergence whole = convergenceOf(runs[0].curve, runs[1].curve, runs[2].curve, window);
   if (!(half.coarseChange > 0) || !(half.scale > 0) || !(whole.scale > 0))
      return std::nullopt;
   return std::max(0.0, std::log2(whole.coarseChange / whole.scale / (half.coarseChange / half.scale)));
}

Estimate errorOf(const AccuracyProbe &probe, double step, bool run)
{
   const auto within = probe.convergence.relativeErrorAt(step / probe.step);
   if (!within)
      return {0, Knowledge::unknown, probe.convergence.doubt()};
   const double longer = probe.errorUntil / probe.window;
   if (longer <= 1 + 1e-9)
      return {*within, run ? Knowledge::measured : Knowledge::predicted,
              run ? "from runs at this step, a half and a quarter of it"
                  : fmt::format("errors go as the step to the power {}",
                                fixedText(probe.convergence.order.value_or(0), 1))};
   if (longer > kFarthest || !probe.growth || *probe.growth > kFastestGrowth)
      return {0, Knowledge::unknown,
              fmt::format("only the first {:.3g} s of {:.3g} s were tried, where it is {} %", probe.window,
                          probe.errorUntil, fixedText(100 * *within, 4))};
   return {
       *within * std::pow(longer, *probe.growth), Knowledge::predicted,
       fmt::format("carried on from the first {:.3g} s, where it is {} % and grows as time to the power {}",
                   probe.window, fixedText(100 * *within, 4), fixedText(*probe.growth, 1))};
}

Estimate secondsOf(const AccuracyProbe &probe, double step, bool withHalf)
{
   double steps = std::ceil(probe.until / step * (1 - 1e-12));
   if (withHalf)
      steps += std::ceil(2 * probe.until / step * (1 - 1e-12));
   return {steps * probe.stepSeconds, Knowledge::predicted,
           fmt::format("{} steps of {} us as measured", fixedText(steps, 0),
                       fixedText(1e6 * probe.stepSeconds, 1))};
}

/// The three runs, and what they tell.
Status runLadder(const Subject &subject, const ProbeRequest &request, AccuracyProbe &probe, const Job &job)
{
   const double coarsest = probe.step;
   const auto fits = std::max<std::int64_t>(1, std::llround(probe.window / coarsest));
   const std::int64_t perSample = (fits + kWindowSamples - 1) / kWindowSamples;
   // Rounding down makes the step longer by at most one part in the samples: still below the limit.
   const std::int64_t samples = std::max<std::int64_t>(1, fits / perSample);
   std::array<TrialRun, 3> runs;
   for (std::size_t k = 0; k < runs.size(); ++k) {
      auto run =
          runTrial(subject, request.values, probe.quantity, probe.window, samples, perSample << k, job);
      if (!run)
         return run.error();
      runs[k] = *std::move(run);
   }
   probe.step = runs[0].step;
   probe.nsPerCellStep =
       1e9 * probe.stepSeconds / static_cast<double>(std::max<std::int64_t>(1, runs[0].cells));
   probe.convergence = judgeRuns(probe.quantity, runs, probe.window);
   probe.scale = probe.convergence.scale;
   probe.growth = growthOf(probe.quantity, runs, probe.window);
   return {};
}

Result<double> baseStep(const Subject &subject, const ProbeRequest &request, const AccuracyProbe &probe,
                        const Job &job)
{
   if (probe.limit.stableStep > 0)
      return probe.limit.stableStep;
   const auto own = ownStep(subject, request.values, probe.errorUntil, kPilotShare * request.budget, job);
   if (!own)
      return own.error();
   return std::min(probe.errorUntil / 20, kMostOwnSteps * *own);
}

void fillPresets(AccuracyProbe &probe)
{
   for (const Preset &preset : kPresets) {
      PresetEstimate estimate;
      estimate.name = preset.name;
      estimate.fraction = preset.fraction;
      estimate.step = preset.fraction * probe.base;
      // Within a tenth the run at the coarsest step is the preset's own: stretches hold whole steps.
      const bool run = std::abs(estimate.step / probe.step - 1) < 0.1;
      estimate.error = errorOf(probe, run ? probe.step : estimate.step, run);
      estimate.seconds = secondsOf(probe, estimate.step, preset.withHalf);
      probe.presets.push_back(std::move(estimate));
   }
}

} // namespace

std::string_view knowledgeText(Knowledge how)
{
   return how == Knowledge::measured ? "measured" : how == Knowledge::predicted ? "predicted" : "unknown";
}

Result<Quantity> busiestQuantity(const Subject &subject, const Values &values, double until, const Job &job)
{
   constexpr std::array<const char *, 3> kChannels{"x", "y", "z"};
   constexpr int kLooks = 16;
   auto simulation = startTrial(subject, values, 0, job);
   if (!simulation)
      return simulation.error();
   const diatom_scene &view = (*simulation)->scene().view();
   (*simulation)->setGoal(until);
   std::size_t cell = 0, axis = 0;
   double most = -1;
   for (int look = 1; look <= kLooks; ++look) {
      if (const Status advanced = (*simulation)->advance(until * look / kLooks, job); !advanced)
         return advanced.error();
      const auto position = (*simulation)->output("position", job);
      if (!position)
         return position.error();
      for (std::size_t k = 0; k < position->size(); ++k)
         if (const double moved = std::abs((*position)[k] - view.cell_position[k]); moved > most) {
            most = moved;
            cell = k / 3;
            axis = k % 3;
         }
   }
   Quantity quantity;
   quantity.cell = (*simulation)->scene().indices()[cell];
   quantity.channel = kChannels[axis];
   return quantity;
}

PresetEstimate estimateAt(const AccuracyProbe &probe, std::string name, double step)
{
   PresetEstimate estimate{std::move(name), step / probe.base, step, errorOf(probe, step, false),
                           secondsOf(probe, step, false)};
   if (probe.limit.stableStep > 0 && step > probe.limit.stableStep * (1 + 1e-9))
      estimate.error = {0, Knowledge::unknown, "beyond the stable limit a run diverges"};
   return estimate;
}

std::optional<double> stepFor(const AccuracyProbe &probe, double error)
{
   const auto within = probe.convergence.relativeErrorAt(1);
   if (!within)
      return std::nullopt;
   const Estimate whole = errorOf(probe, probe.step, true);
   const double coarsest = whole.how == Knowledge::unknown ? *within : whole.value;
   if (coarsest <= error || probe.convergence.settled)
      return coarsest <= error ? std::optional(probe.step) : std::nullopt;
   const double fraction = std::pow(error / coarsest, 1 / *probe.convergence.order);
   return fraction >= kFinest ? std::optional(fraction * probe.step) : std::nullopt;
}

Result<AccuracyProbe> probeAccuracy(const Subject &subject, const ProbeRequest &request, const Job &job)
{
   const auto start = Clock::now();
   if (!(request.until > 0) || !(request.budget > 0))
      return Error{ErrorCode::usage, "the length of the run and the time for the probe must be above 0"};
   if (request.quantity && request.quantity->when == Quantity::When::atRest)
      return Error{ErrorCode::usage, "a state of rest does not depend on the step; probe a motion"};
   AccuracyProbe probe;
   auto limit = findStepLimit(subject, request.values, job);
   if (!limit)
      return limit.error();
   probe.limit = *std::move(limit);
   probe.until = probe.errorUntil = request.until;
   if (request.quantity && request.quantity->when == Quantity::When::atTime)
      probe.errorUntil = std::min(probe.until, request.quantity->time);
   const auto base = baseStep(subject, request, probe, job);
   if (!base)
      return base.error();
   probe.base = *base;
   probe.step = kCoarsestStep * probe.base;
   const auto stepSeconds =
       timeStep(subject, request.values, probe.step, probe.until, kPilotShare * request.budget, job);
   if (!stepSeconds)
      return stepSeconds.error();
   const bool search = !request.quantity;
   probe.stepSeconds = *stepSeconds;
   const double runs = 1 + 2 + 4 + (search ? 1 : 0); // in units of the coarsest one
   const double steps = std::max<double>(kFewestSteps, kRunsShare * request.budget / runs / *stepSeconds);
   probe.window = std::min(probe.errorUntil, steps * probe.step);
   if (search) {
      auto busiest = busiestQuantity(subject, request.values, probe.window, job);
      if (!busiest)
         return busiest.error();
      probe.quantity = *std::move(busiest);
   } else {
      probe.quantity = *request.quantity;
   }
   if (const Status ran = runLadder(subject, request, probe, job); !ran)
      return ran.error();
   fillPresets(probe);
   probe.probeSeconds = secondsSince(start);
   return probe;
}

} // namespace diatom
