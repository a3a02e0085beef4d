#include "study/accuracy_judge.h"

#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace diatom {

namespace {

/// Newton's method leaves this part of the forces unbalanced at most: see BalanceRequest.
constexpr double kBalanceError = 1e-8;

class Judge
{
public:
   explicit Judge(AccuracyRuns &runs)
       : m_runs(runs), m_quantity(runs.request().quantity), m_until(runs.request().until)
   {}

   AccuracyStudy study();

private:
   void judgeLadders();
   AccuracyReference reference();
   std::optional<AccuracyReference> given();
   std::optional<AccuracyReference> balance();
   AccuracyReference finestMotion();
   std::optional<double> errorOf(const AccuracyRun &run) const;
   int carefulRow() const;
   void markFront(AccuracyStudy &study) const;

   AccuracyRuns &m_runs;
   Quantity m_quantity;
   double m_until;
   std::optional<double> m_value;
   std::optional<History> m_history;
   double m_scale = 0;
};

Convergence convergenceOfRuns(const Quantity &quantity, double until,
                              const std::array<const AccuracyRun *, 3> &runs)
{
   if (quantity.when == Quantity::When::throughout)
      return convergenceOf(runs[0]->run->curve, runs[1]->run->curve, runs[2]->run->curve, until);
   const auto &[a, b, c] = runs;
   return a->value && b->value && c->value ? convergenceOf(*a->value, *b->value, *c->value) : Convergence{};
}

void Judge::judgeLadders()
{
   for (AccuracyLadder &ladder : m_runs.ladders()) {
      std::vector<const AccuracyRun *> done;
      for (const std::size_t k : ladder.rows)
         if (m_runs.runs()[k].run)
            done.push_back(&m_runs.runs()[k]);
      if (const std::size_t n = done.size(); n >= 3)
         ladder.convergence = convergenceOfRuns(m_quantity, m_until, {done[n - 3], done[n - 2], done[n - 1]});
   }
}

std::optional<AccuracyReference> Judge::given()
{
   for (const Reference &one : m_runs.variants().front().subject.setup.references)
      if (one.quantity == m_quantity.text()) {
         m_value = one.value;
         m_scale = std::abs(one.value);
         AccuracyReference found;
         found.exact = found.asymptotic = true;
         found.value = one.value;
         found.source = one.source;
         return found;
      }
   return std::nullopt;
}

/// The balance at the finest resolution of the last model tried, or what three resolutions tend to.
std::optional<AccuracyReference> Judge::balance()
{
   const std::string model = m_runs.variants().back().model;
   std::vector<const AccuracyRun *> found;
   for (const AccuracyLadder &ladder : m_runs.ladders()) {
      const AccuracyRun &run = m_runs.runs()[ladder.rows.front()];
      if (ladder.analysis != Analysis::dynamics && run.value &&
          m_runs.variants()[ladder.variant].model == model && (ladder.own || !model.empty()))
         found.push_back(&run);
   }
   if (found.empty())
      return std::nullopt;
   const std::size_t n = found.size();
   AccuracyReference answer;
   answer.value = *found.back()->value;
   answer.source =
       fmt::format("{} at resolution {}", found.back()->row.setting, found.back()->row.resolution);
   answer.asymptotic = n == 1;
   if (n == 1)
      answer.ownError = kBalanceError;
   else
      answer.doubt = "three resolutions that approach one limit in order are needed to tell its error";
   if (n >= 3) {
      std::array<double, 3> times{}, values{};
      for (std::size_t k = 0; k < 3; ++k) {
         times[k] = found[n - 3 + k]->row.resolution;
         values[k] = *found[n - 3 + k]->value;
      }
      if (const auto limit = resolutionLimit(times, values)) {
         answer.source = fmt::format("{}, what resolutions up to {} tend to", found.back()->row.setting,
                                     found.back()->row.resolution);
         answer.ownError = std::abs(limit->limit - answer.value) / std::abs(limit->limit);
         answer.order = limit->order;
         answer.value = limit->limit;
         answer.asymptotic = true;
         answer.doubt.clear();
      }
   }
   m_value = answer.value;
   m_scale = std::abs(answer.value);
   return answer;
}

AccuracyReference Judge::finestMotion()
{
   const AccuracyLadder *best = nullptr, *own = nullptr;
   for (const AccuracyLadder &ladder : m_runs.ladders()) {
      if (!ladder.own || ladder.analysis != Analysis::dynamics || !m_runs.runs()[ladder.rows.front()].run)
         continue;
      own = own ? own : &ladder;
      const auto error = ladder.convergence.relativeErrorAt(0.25);
      const bool finer = best && ladder.variant > best->variant;
      if (error && (!best || finer || *error < *best->convergence.relativeErrorAt(0.25)))
         best = &ladder;
   }
   const AccuracyLadder *from = best ? best : own;
   AccuracyReference found;
   if (!from)
      return found;
   const AccuracyRun *finest = nullptr, *coarser = nullptr;
   for (const std::size_t k : from->rows)
      if (m_runs.runs()[k].run) {
         coarser = finest;
         finest = &m_runs.runs()[k];
      }
   m_history = finest->run->curve;
   m_value = finest->value;
   found.value = m_value.value_or(0);
   found.source = fmt::format("{} at a step of {:.3g} s, resolution {}", from->setting, finest->row.step,
                              finest->row.resolution);
   found.ownError = from->convergence.relativeErrorAt(0.25);
   found.order = from->convergence.order;
   found.asymptotic = found.ownError.has_value();
   found.doubt = from->convergence.doubt();
   m_scale = m_quantity.when == Quantity::When::throughout ? largestValue(*m_history, m_until)
                                                           : std::abs(found.value);
   if (!found.asymptotic && coarser)
      found.disagreement = errorOf(*coarser);
   return found;
}

AccuracyReference Judge::reference()
{
   if (auto found = given())
      return *std::move(found);
   if (isStill(m_quantity))
      if (auto found = balance())
         return *std::move(found);
   return finestMotion();
}

std::optional<double> Judge::errorOf(const AccuracyRun &run) const
{
   if (!run.done() || !(m_scale > 0))
      return std::nullopt;
   if (m_quantity.when == Quantity::When::throughout && m_history && run.run)
      return largestDifference(run.run->curve, *m_history, m_until) / m_scale;
   return run.value && m_value ? std::optional(std::abs(*run.value - *m_value) / m_scale) : std::nullopt;
}

int Judge::carefulRow() const
{
   const bool cut = m_runs.request().request.resolutions.size() > 1;
   int balance = -1, motion = -1;
   for (const AccuracyLadder &ladder : m_runs.ladders()) {
      const bool still = ladder.analysis != Analysis::dynamics;
      if (still && cut && m_runs.runs()[ladder.rows.back()].done())
         balance = static_cast<int>(ladder.rows.back());
      for (const std::size_t k : ladder.rows)
         if (!still && m_runs.runs()[k].done() &&
             (motion < 0 ||
              m_runs.runs()[k].ladder == m_runs.runs()[static_cast<std::size_t>(motion)].ladder))
            motion = static_cast<int>(k);
   }
   return balance >= 0 ? balance : motion;
}

void Judge::markFront(AccuracyStudy &study) const
{
   std::vector<int> order;
   for (std::size_t k = 0; k < study.rows.size(); ++k)
      if (study.rows[k].error)
         order.push_back(static_cast<int>(k));
   const auto at = [&](int k) -> AccuracyRow & { return study.rows[static_cast<std::size_t>(k)]; };
   std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return at(a).seconds < at(b).seconds; });
   // A run cannot be told nearer to the truth than what it is held against.
   const AccuracyReference &held = study.reference;
   const double doubt =
       held.exact
           ? 0
           : held.ownError.value_or(held.disagreement.value_or(std::numeric_limits<double>::infinity()));
   double best = std::numeric_limits<double>::infinity();
   for (const int k : order) {
      if (study.cheapest < 0 && *at(k).error + doubt <= study.tolerance)
         study.cheapest = k;
      if (*at(k).error >= best)
         continue;
      best = *at(k).error;
      at(k).onFront = true;
   }
}

AccuracyStudy Judge::study()
{
   judgeLadders();
   AccuracyStudy study;
   study.quantity = m_quantity;
   study.until = m_until;
   study.tolerance = m_runs.request().request.tolerance;
   study.reference = reference();
   study.scale = m_scale;
   for (AccuracyRun &run : m_runs.runs()) {
      if (run.done()) {
         run.row.value = run.value.value_or(0);
         run.row.seconds = median(run.seconds);
         run.row.repeats = static_cast<int>(run.seconds.size());
      }
      run.row.error = errorOf(run);
      study.rows.push_back(run.row);
   }
   study.careful = carefulRow();
   study.notes = m_runs.notes();
   study.seconds = m_runs.spent();
   markFront(study);
   return study;
}

} // namespace

AccuracyStudy judgeRuns(AccuracyRuns &runs) { return Judge(runs).study(); }

Result<double> sensitivityOf(const Subject &subject, const AccuracyPlan &plan, const Job &job)
{
   constexpr double kChange = 1e-9;
   constexpr std::int64_t kLooks = 16;
   Model changed = subject.hierarchy->model();
   auto materials = std::make_shared<std::vector<Material>>(*changed.materials);
   for (Material &material : *materials)
      material.density *= 1 + kChange;
   changed.materials = materials;
   const auto lattice = Lattice::make(*subject.catalogue, changed.lattice, job);
   if (!lattice)
      return lattice.error();
   Subject other = subject;
   other.hierarchy = std::make_shared<const Hierarchy>(*lattice, std::move(changed));
   const auto limit = findStepLimit(subject, {}, job);
   if (!limit)
      return limit.error();
   const double step = limit->stableStep > 0 ? 0.45 * limit->stableStep : plan.until / 1000;
   const auto perLook = static_cast<std::int64_t>(std::ceil(plan.until / kLooks / step));
   const auto a = runTrial(subject, {}, plan.quantity, plan.until, kLooks, perLook, job);
   const auto b = runTrial(other, {}, plan.quantity, plan.until, kLooks, perLook, job);
   if (!a || !b)
      return a ? b.error() : a.error();
   const double scale = largestValue(a->curve, plan.until);
   return scale > 0 ? largestDifference(a->curve, b->curve, plan.until) / scale / kChange : 0.0;
}

} // namespace diatom
