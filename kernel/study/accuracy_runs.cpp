#include "study/accuracy_runs.h"

#include "core/text.h"
#include "study/refine.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace diatom {

namespace {

using Clock = std::chrono::steady_clock;

/// Parameters of a solver that this study walks through, where the solver has them. The first two say how the
/// model is solved, the others what the model is.
constexpr std::array<std::string_view, 4> kAxes{"integrator", "precision", "gradient", "beam"};
constexpr std::size_t kSolvingAxes = 2;

constexpr int kLevels = 4;                // step lengths of a ladder, each half of the one before
constexpr double kCoarsest = 0.9;         // of the stable step
constexpr std::int64_t kSamples = 16;     // of a curve
constexpr std::int64_t kSwings = 384;     // samples where a frequency is wanted: some sixty a swing
constexpr double kStepsWithoutLimit = 16; // in the run, at the coarsest, for solvers that no step can upset
constexpr double kFirstPass = 0.6;        // of the budget; the rest is for timing again
/// A setting not yet tried may take this many times as long a step as the scene's own: Runge-Kutta takes
/// four.
constexpr double kUnknownCost = 5;

double magnitude(double value) { return std::abs(value); }

} // namespace

AccuracyRuns::AccuracyRuns(Subject subject, AccuracyPlan plan)
    : m_subjects{std::move(subject)}, m_plan(std::move(plan)), m_start(Clock::now())
{
   m_choices = solverChoices(*m_subjects.front().catalogue, m_subjects.front().setup.solver,
                             m_subjects.front().setup.solverValues, kAxes);
}

double AccuracyRuns::spent() const { return std::chrono::duration<double>(Clock::now() - m_start).count(); }

Status AccuracyRuns::planRows(const Job &job)
{
   const Subject whole = m_subjects.front();
   m_subjects.clear();
   for (const int times : m_plan.request.resolutions) {
      auto refined = refineScene(whole.hierarchy, whole.setup, *whole.catalogue, times, job);
      if (!refined)
         return refined.error();
      m_subjects.push_back({whole.catalogue, refined->hierarchy, refined->setup, times});
   }
   double longest = 0;
   std::vector<Ladder> ladders;
   for (std::size_t resolution = 0; resolution < m_subjects.size(); ++resolution)
      for (const Values &values : combinations(m_choices)) {
         Ladder ladder;
         ladder.resolution = resolution;
         ladder.values = values;
         ladder.setting = settingText(m_choices, values);
         // What is not the model itself: the integrator alone, at the scene's own precision and model.
         ladder.reference = std::all_of(m_choices.begin(), m_choices.end(), [&](const Choice &choice) {
            return choice.name == kAxes.front() ||
                   std::get<std::string>(values.at(choice.name)) == choice.choices.front();
         });
         if (resolution > 0 && !ladder.reference)
            continue;
         const auto limit = findStepLimit(m_subjects[resolution], values, job);
         if (!limit)
            return limit.error();
         ladder.limit = limit->stableStep;
         longest = std::max(longest, ladder.limit);
         ladders.push_back(std::move(ladder));
      }
   const double stretches = longest > 0 ? m_plan.until / longest : kStepsWithoutLimit;
   const bool swings = m_plan.quantity.when == Quantity::When::frequency;
   m_samples =
       std::clamp<std::int64_t>(std::llround(std::min(stretches, 1e6)), 1, swings ? kSwings : kSamples);
   for (Ladder &ladder : ladders)
      addLadder(std::move(ladder));
   return {};
}

void AccuracyRuns::addLadder(Ladder ladder)
{
   const double stretch = m_plan.until / static_cast<double>(m_samples);
   const double coarsest = ladder.limit > 0 ? kCoarsest * ladder.limit : m_plan.until / kStepsWithoutLimit;
   ladder.perSample = std::max<std::int64_t>(1, std::llround(std::ceil(stretch / coarsest * (1 - 1e-9))));
   for (int level = 0; level < kLevels; ++level) {
      Row row;
      row.ladder = m_ladders.size();
      row.perSample = ladder.perSample << level;
      row.row.analysis = "dynamics";
      row.row.setting = ladder.setting;
      row.row.values = ladder.values;
      row.row.resolution = m_subjects[ladder.resolution].resolution;
      row.row.step = stretch / static_cast<double>(row.perSample);
      row.row.fraction = ladder.limit > 0 ? row.row.step / ladder.limit : 0;
      ladder.rows.push_back(m_rows.size());
      m_rows.push_back(std::move(row));
   }
   m_ladders.push_back(std::move(ladder));
}

double AccuracyRuns::predictedSeconds(const Row &row) const
{
   const double steps = static_cast<double>(row.perSample * m_samples);
   const Ladder &ladder = m_ladders[row.ladder];
   for (const std::size_t k : ladder.rows)
      if (m_rows[k].run)
         return steps * m_rows[k].run->stepSeconds;
   for (const Row &other : m_rows)
      if (other.run) {
         const double larger = std::pow(m_subjects[ladder.resolution].resolution, 3) /
                               std::pow(m_subjects[m_ladders[other.ladder].resolution].resolution, 3);
         return steps * kUnknownCost * larger * other.run->stepSeconds;
      }
   return 0;
}

Status AccuracyRuns::runRow(Row &row, const Job &job)
{
   auto run = runTrial(m_subjects[m_ladders[row.ladder].resolution], row.row.values, m_plan.quantity,
                       m_plan.until, m_samples, row.perSample, job);
   if (!run)
      return run.error();
   row.seconds.push_back(run->seconds);
   row.run = *std::move(run);
   return {};
}

Status AccuracyRuns::runAll(const Job &job)
{
   const double budget = m_plan.request.budget;
   std::optional<Error> first;
   std::size_t done = 0, left = 0;
   for (Row &row : m_rows) {
      job.progress(0.6 * static_cast<double>(done++) / static_cast<double>(m_rows.size()), "accuracy study");
      if (row.ladder > 0 && spent() + predictedSeconds(row) > kFirstPass * budget) {
         row.row.note = "left out: beyond the time budget";
         ++left;
         continue;
      }
      const Status ran = runRow(row, job);
      if (!ran && ran.error().code == ErrorCode::cancelled)
         return ran;
      if (!ran)
         row.row.note = ran.error().message;
      if (!ran && !first)
         first = ran.error();
   }
   if (left > 0)
      m_notes.push_back(
          fmt::format("{} of {} settings did not fit the budget of {} s; raise --budget to have "
                      "them run",
                      left, m_rows.size(), numberText(budget)));
   if (std::none_of(m_rows.begin(), m_rows.end(), [](const Row &row) { return row.run.has_value(); }))
      return first ? *first : Error{ErrorCode::invalid, "nothing could be run within the budget"};
   // Again and in turns, so that a busy moment of the machine falls on all alike.
   for (int repeat = 1; repeat < m_plan.request.repeats; ++repeat)
      for (Row &row : m_rows) {
         if (!row.run || spent() + row.run->seconds > budget)
            continue;
         job.progress(std::min(1.0, spent() / budget), "accuracy study, timing again");
         if (const Status ran = runRow(row, job); !ran)
            return ran;
      }
   return {};
}

std::optional<double> AccuracyRuns::valueOf(const History &history) const
{
   if (m_plan.quantity.when == Quantity::When::frequency)
      return historyFrequency(history);
   return history.value.back();
}

Convergence AccuracyRuns::convergenceOfRows(const Row &a, const Row &b, const Row &c) const
{
   const History &coarse = a.run->curve, &middle = b.run->curve, &fine = c.run->curve;
   if (m_plan.quantity.when == Quantity::When::throughout)
      return convergenceOf(coarse, middle, fine, m_plan.until);
   const auto x = valueOf(coarse), y = valueOf(middle), z = valueOf(fine);
   return x && y && z ? convergenceOf(*x, *y, *z) : Convergence{};
}

void AccuracyRuns::judgeLadders()
{
   for (Ladder &ladder : m_ladders) {
      std::vector<const Row *> done;
      for (const std::size_t k : ladder.rows)
         if (m_rows[k].run)
            done.push_back(&m_rows[k]);
      const std::size_t n = done.size();
      if (n >= 3)
         ladder.convergence = convergenceOfRows(*done[n - 3], *done[n - 2], *done[n - 1]);
   }
}

int AccuracyRuns::surestLadder() const
{
   int surest = -1;
   double least = std::numeric_limits<double>::infinity();
   std::size_t finest = 0;
   for (std::size_t k = 0; k < m_ladders.size(); ++k) {
      const auto error = m_ladders[k].convergence.relativeErrorAt(0.25);
      if (!m_ladders[k].reference || !error || m_ladders[k].resolution < finest)
         continue;
      if (m_ladders[k].resolution > finest)
         least = std::numeric_limits<double>::infinity();
      if (*error >= least)
         continue;
      finest = m_ladders[k].resolution;
      least = *error;
      surest = static_cast<int>(k);
   }
   return surest;
}

AccuracyReference AccuracyRuns::findReference()
{
   AccuracyReference found;
   for (const Reference &given : m_subjects.front().setup.references)
      if (given.quantity == m_plan.quantity.text()) {
         m_referenceValue = given.value;
         m_scale = magnitude(given.value);
         return {true, given.value, given.source, std::nullopt, std::nullopt, true, ""};
      }
   const int surest = surestLadder();
   const Ladder *ladder = surest < 0 ? &m_ladders.front() : &m_ladders[static_cast<std::size_t>(surest)];
   const Row *finest = nullptr;
   for (const std::size_t k : ladder->rows)
      if (m_rows[k].run)
         finest = &m_rows[k];
   if (!finest)
      return found;
   m_referenceHistory = finest->run->curve;
   m_referenceValue = valueOf(finest->run->curve);
   found.value = m_referenceValue.value_or(0);
   found.source = fmt::format("{} at a step of {} s, resolution {}", ladder->setting,
                              numberText(finest->row.step), finest->row.resolution);
   found.ownError = ladder->convergence.relativeErrorAt(0.25);
   found.order = ladder->convergence.order;
   found.asymptotic = found.ownError.has_value();
   found.doubt = ladder->convergence.doubt();
   m_scale = m_plan.quantity.when == Quantity::When::throughout
                 ? largestValue(*m_referenceHistory, m_plan.until)
                 : magnitude(found.value);
   return found;
}

std::optional<double> AccuracyRuns::errorOf(const Row &row) const
{
   if (!row.run || !(m_scale > 0))
      return std::nullopt;
   if (m_plan.quantity.when == Quantity::When::throughout && m_referenceHistory)
      return largestDifference(row.run->curve, *m_referenceHistory, m_plan.until) / m_scale;
   const auto value = valueOf(row.run->curve);
   return value && m_referenceValue ? std::optional(magnitude(*value - *m_referenceValue) / m_scale)
                                    : std::nullopt;
}

AccuracyStudy AccuracyRuns::judged()
{
   judgeLadders();
   AccuracyStudy study;
   study.quantity = m_plan.quantity;
   study.until = m_plan.until;
   study.tolerance = m_plan.request.tolerance;
   study.reference = findReference();
   study.scale = m_scale;
   for (Row &row : m_rows) {
      if (row.run) {
         row.row.steps = row.run->steps;
         row.row.cells = row.run->cells;
         row.row.value = valueOf(row.run->curve).value_or(0);
         row.row.seconds = median(row.seconds);
         row.row.repeats = static_cast<int>(row.seconds.size());
         row.row.nsPerCellStep = row.run->nsPerCellStep();
      }
      row.row.error = errorOf(row);
      study.rows.push_back(row.row);
   }
   if (m_rows[kLevels - 1].run)
      study.careful = kLevels - 1;
   study.notes = m_notes;
   study.seconds = spent();
   return study;
}

} // namespace diatom
