#include "study/accuracy_runs.h"

#include "core/clock.h"
#include "core/text.h"
#include "study/refine.h"
#include "study/step_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace diatom {

namespace {

/// Parameters of a solver that this study walks through, where the solver has them. The first two say how the
/// model is solved, the others what the model is.
constexpr std::array<std::string_view, 4> kAxes{"integrator", "precision", "gradient", "beam"};
constexpr std::size_t kSolvingAxes = 2;

constexpr int kLevels = 4; // step lengths of a ladder, each half of the one before
constexpr int kLevelsWithoutLimit = 7;
/// Of the steps that a solver without a limit chooses for itself: the longest to try. Where only the end
/// counts, the way there may be coarse.
constexpr double kCoarsestOwnSteps = 16;
constexpr double kOwnShare = 0.02;          // of the budget, for seeing such a choice
constexpr std::int64_t kCurveSamples = 16;  // of a curve
constexpr std::int64_t kSwingSamples = 512; // samples where a frequency is wanted: some sixty a swing
constexpr double kStepsWithoutLimit = 8;    // in the run, at the coarsest, for solvers that no step can upset
constexpr double kFirstPass = 0.7;          // of the budget; the rest is for timing again
/// Settings whose longest step is below this part of the longest of all come last: they are there to compare.
constexpr double kShortStep = 0.1;
/// A setting not yet tried may take this many times as long a step as the scene's own: Runge-Kutta takes
/// four.
constexpr double kUnknownCost = 5;

/// Axes at which values differ from the scene's: of solving, and of the model.
std::array<int, 2> unlike(const std::vector<Choice> &choices, const Values &values)
{
   std::array<int, 2> count{0, 0};
   for (const Choice &choice : choices)
      if (std::get<std::string>(values.at(choice.name)) != choice.choices.front())
         ++count[choice.name == kAxes[0] || choice.name == kAxes[1] ? 0 : 1];
   return count;
}

/// Of the curve that the quantity is read from.
std::int64_t mostSamples(const AccuracyPlan &plan)
{
   switch (plan.quantity.when) {
   case Quantity::When::frequency:
      return kSwingSamples;
   case Quantity::When::atTime:
      return plan.quantity.time >= plan.until ? 1 : kCurveSamples;
   default:
      return kCurveSamples;
   }
}

/// "verlet f64"; what else differs from the scene follows a comma.
std::string nameOf(const std::vector<Choice> &choices, const Values &values, bool motion)
{
   std::string name = motion ? "" : "statics", other;
   for (const Choice &choice : choices) {
      const std::string &value = std::get<std::string>(values.at(choice.name));
      const auto axis =
          static_cast<std::size_t>(std::find(kAxes.begin(), kAxes.end(), choice.name) - kAxes.begin());
      if (axis < kSolvingAxes && motion)
         name += (name.empty() ? "" : " ") + value;
      else if (axis >= kSolvingAxes && value != choice.choices.front())
         other += ", " + value;
   }
   return name + other;
}

} // namespace

AccuracyRuns::AccuracyRuns(Subject subject, AccuracyPlan plan)
    : m_variants{{std::move(subject), ""}}, m_plan(std::move(plan)), m_start(Clock::now())
{
   const Subject &own = m_variants.front().subject;
   m_choices = solverChoices(*own.catalogue, own.setup.solver, own.setup.solverValues, kAxes);
}

double AccuracyRuns::spent() const { return secondsSince(m_start); }

std::optional<double> AccuracyRuns::valueOf(const History &history) const
{
   if (m_plan.quantity.when == Quantity::When::frequency)
      return historyFrequency(history);
   return history.value.back();
}

Status AccuracyRuns::addVariants(const Job &job)
{
   const Subject whole = m_variants.front().subject;
   m_variants.clear();
   for (const int times : m_plan.request.resolutions) {
      auto cut = refineScene(whole.hierarchy, whole.setup, *whole.catalogue, times, job);
      if (!cut)
         return cut.error();
      m_variants.push_back({{whole.catalogue, cut->hierarchy, cut->setup, times}, ""});
      const Subject own = m_variants.back().subject;
      for (const CellModel model : m_plan.request.models) {
         auto other = withCellModel(own, model, job);
         if (!other)
            return other.error();
         m_variants.push_back({*std::move(other), cellModelName(model)});
      }
   }
   return {};
}

void AccuracyRuns::planStill(std::size_t variant)
{
   const SubjectVariant &of = m_variants[variant];
   for (const Values &values : combinations(m_choices)) {
      const auto [solving, model] = unlike(m_choices, values);
      // Only the beam theory can matter to a balance; blocks and solids have none of their own.
      const auto gradient = values.find("gradient");
      const bool exact = gradient == values.end() || std::get<std::string>(gradient->second) == "exact";
      if (solving > 0 || model > (of.model.empty() ? 1 : 0) || !exact)
         continue;
      AccuracyLadder ladder;
      ladder.variant = variant;
      ladder.values = values;
      ladder.values.erase("integrator");
      ladder.analysis = stillAnalysis(m_plan.quantity);
      ladder.setting = nameOf(m_choices, values, false);
      if (ladder.analysis == Analysis::modes)
         ladder.setting.replace(0, 7, "modes");
      if (!of.model.empty())
         ladder.setting += ", " + of.model;
      ladder.own = of.model.empty() && model == 0;
      m_ladders.push_back(std::move(ladder));
   }
}

Status AccuracyRuns::planMotion(std::size_t variant, const Job &job)
{
   const SubjectVariant &of = m_variants[variant];
   if (!of.model.empty())
      return {};
   for (const Values &values : combinations(m_choices)) {
      const auto [solving, model] = unlike(m_choices, values);
      const bool cut = of.subject.resolution > 1;
      if (model > 1 || (model == 1 && solving > 0) || (cut && solving + model > 0))
         continue; // one thing at a time: the whole product would take hours and tell no more
      AccuracyLadder ladder;
      ladder.variant = variant;
      ladder.values = values;
      ladder.setting = nameOf(m_choices, values, true);
      const auto precision = values.find("precision");
      ladder.own =
          model == 0 && (precision == values.end() || std::get<std::string>(precision->second) == "f64");
      const auto limit = findStepLimit(of.subject, values, job);
      if (!limit)
         return limit.error();
      ladder.limit = limit->stableStep;
      ladder.coarsest = kCoarsestStep * ladder.limit;
      if (ladder.limit <= 0) {
         const auto own = ownStep(of.subject, values, m_plan.until, kOwnShare * m_plan.request.budget, job);
         if (!own && own.error().code == ErrorCode::cancelled)
            return own.error();
         // What the solver refuses is told by the runs themselves.
         ladder.coarsest = m_plan.until / kStepsWithoutLimit;
         if (own)
            ladder.coarsest = std::min(ladder.coarsest, kCoarsestOwnSteps * *own);
      }
      m_ladders.push_back(std::move(ladder));
   }
   return {};
}

Status AccuracyRuns::plan(const Job &job)
{
   if (Status added = addVariants(job); !added)
      return added;
   for (std::size_t variant = 0; variant < m_variants.size(); ++variant)
      if (isStill(m_plan.quantity))
         planStill(variant);
   for (std::size_t variant = 0; variant < m_variants.size(); ++variant)
      if (Status planned = planMotion(variant, job); !planned)
         return planned;
   double longest = 0;
   for (const AccuracyLadder &ladder : m_ladders)
      longest = std::max(longest, ladder.limit);
   std::stable_partition(m_ladders.begin(), m_ladders.end(), [&](const AccuracyLadder &ladder) {
      return !(ladder.limit > 0 && ladder.limit < kShortStep * longest);
   });
   addSteps(longest);
   return {};
}

void AccuracyRuns::addSteps(double longest)
{
   const double stretches = longest > 0 ? m_plan.until / longest : kStepsWithoutLimit;
   m_samples = std::clamp<std::int64_t>(std::llround(std::min(stretches, 1e6)), 1, mostSamples(m_plan));
   const double stretch = m_plan.until / static_cast<double>(m_samples);
   for (std::size_t k = 0; k < m_ladders.size(); ++k) {
      AccuracyLadder &ladder = m_ladders[k];
      const bool motion = ladder.analysis == Analysis::dynamics;
      const auto perSample =
          motion ? std::max<std::int64_t>(1, std::llround(std::ceil(stretch / ladder.coarsest * (1 - 1e-9))))
                 : 1;
      const int levels = !motion ? 1 : ladder.limit > 0 ? kLevels : kLevelsWithoutLimit;
      for (int level = 0; level < levels; ++level) {
         AccuracyRun one;
         one.ladder = k;
         one.perSample = perSample << level;
         one.row.analysis = analysisName(ladder.analysis);
         one.row.setting = ladder.setting;
         one.row.values = ladder.values;
         one.row.resolution = m_variants[ladder.variant].subject.resolution;
         one.row.step = motion ? stretch / static_cast<double>(one.perSample) : 0;
         one.row.fraction = ladder.limit > 0 ? one.row.step / ladder.limit : 0;
         ladder.rows.push_back(m_runs.size());
         m_runs.push_back(std::move(one));
      }
   }
}

double AccuracyRuns::predictedSeconds(const AccuracyRun &one) const
{
   const AccuracyLadder &ladder = m_ladders[one.ladder];
   if (ladder.analysis != Analysis::dynamics)
      return 0; // seldom more than a second, and not to be told before
   const double steps = static_cast<double>(one.perSample * m_samples);
   for (const std::size_t k : ladder.rows)
      if (m_runs[k].run)
         return steps * m_runs[k].run->stepSeconds;
   for (const AccuracyRun &other : m_runs)
      if (other.run) {
         const double larger = std::pow(variantOf(ladder).subject.resolution, 3) /
                               std::pow(variantOf(m_ladders[other.ladder]).subject.resolution, 3);
         return steps * kUnknownCost * larger * other.run->stepSeconds;
      }
   return 0;
}

Status AccuracyRuns::run(AccuracyRun &one, const Job &job)
{
   const AccuracyLadder &ladder = m_ladders[one.ladder];
   const Subject &subject = variantOf(ladder).subject;
   if (ladder.analysis != Analysis::dynamics) {
      const auto still = runStill(subject, ladder.values, m_plan.quantity, job);
      if (!still)
         return still.error();
      one.value = still->value;
      one.row.cells = still->cells;
      one.row.steps = still->iterations;
      one.seconds.push_back(still->seconds);
      return {};
   }
   auto run = runTrial(subject, ladder.values, m_plan.quantity, m_plan.until, m_samples, one.perSample, job);
   if (!run)
      return run.error();
   one.value = valueOf(run->curve);
   one.row.cells = run->cells;
   one.row.steps = run->steps;
   one.row.nsPerCellStep = run->nsPerCellStep();
   one.seconds.push_back(run->seconds);
   one.run = *std::move(run);
   return {};
}

Status AccuracyRuns::runAll(const Job &job)
{
   const double budget = m_plan.request.budget;
   std::optional<Error> first;
   std::size_t looked = 0, left = 0;
   for (AccuracyRun &one : m_runs) {
      job.progress(0.6 * static_cast<double>(looked++) / static_cast<double>(m_runs.size()),
                   "accuracy study");
      if (spent() + predictedSeconds(one) > kFirstPass * budget && looked > 1) {
         one.row.note = "left out: beyond the time budget";
         ++left;
         continue;
      }
      Status ran = run(one, job);
      if (!ran && ran.error().code == ErrorCode::cancelled)
         return ran;
      if (!ran)
         one.row.note = ran.error().message;
      if (!ran && !first)
         first = ran.error();
   }
   if (left > 0)
      m_notes.push_back(fmt::format("{} of {} runs did not fit the budget of {} s; raise --budget to have "
                                    "them made",
                                    left, m_runs.size(), numberText(budget)));
   if (std::none_of(m_runs.begin(), m_runs.end(), [](const AccuracyRun &one) { return one.done(); }))
      return first ? *first : Error{ErrorCode::invalid, "nothing could be run within the budget"};
   // Again and in turns, so that a busy moment of the machine falls on all alike.
   for (int repeat = 1; repeat < m_plan.request.repeats; ++repeat)
      for (AccuracyRun &one : m_runs) {
         if (!one.done() || spent() + one.seconds.back() > budget)
            continue;
         job.progress(std::min(1.0, spent() / budget), "accuracy study, timing again");
         if (Status ran = run(one, job); !ran)
            return ran;
      }
   return {};
}

} // namespace diatom
