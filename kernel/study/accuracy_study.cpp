#include "study/accuracy_study.h"

#include "study/accuracy_judge.h"
#include "study/motion_time.h"

#include <fmt/format.h>

namespace diatom {

namespace {

/// What the scene is run for, where the request leaves it open.
Result<AccuracyPlan> planOf(const Subject &subject, const AccuracyRequest &request, const Job &job)
{
   AccuracyPlan plan;
   plan.request = request;
   if (request.quantity)
      plan.quantity = *request.quantity;
   else if (!subject.setup.references.empty()) {
      auto parsed = parseQuantity(subject.setup.references.front().quantity);
      if (!parsed)
         return parsed.error();
      plan.quantity = *std::move(parsed);
   }
   plan.until = request.until;
   const bool atTime = plan.quantity.when == Quantity::When::atTime;
   if (atTime)
      plan.until = plan.quantity.time;
   if (plan.until <= 0) {
      const auto time = motionTime(subject, job);
      if (!time)
         return time.error();
      // Frequencies want some swings, a state of rest a multiple of the time of a swing.
      const bool longer = plan.quantity.when != Quantity::When::throughout;
      plan.until = longer ? 6 * *time : *time;
   }
   if (plan.quantity.channel.empty()) {
      auto busiest = busiestQuantity(subject, {}, plan.until, job);
      if (!busiest)
         return busiest.error();
      plan.quantity = *std::move(busiest);
   }
   // One number can be compared between resolutions, curves of cells at slightly different places cannot.
   if (request.resolutions != std::vector<int>{1} && plan.quantity.when == Quantity::When::throughout) {
      plan.quantity.when = Quantity::When::atTime;
      plan.quantity.time = plan.until;
   }
   return plan;
}

} // namespace

std::optional<double> AccuracyStudy::gain() const
{
   if (cheapest < 0 || careful < 0)
      return std::nullopt;
   const double own = rows[static_cast<std::size_t>(cheapest)].seconds;
   return own > 0 ? std::optional(rows[static_cast<std::size_t>(careful)].seconds / own) : std::nullopt;
}

Result<AccuracyStudy> studyAccuracy(const std::shared_ptr<const Catalogue> &catalogue, const Design &design,
                                    const AccuracyRequest &request, const Job &job)
{
   const auto lattice = Lattice::make(*catalogue, design.model.lattice, job);
   if (!lattice)
      return lattice.error();
   Subject subject{catalogue, std::make_shared<const Hierarchy>(*lattice, design.model), design.setup, 1};
   subject.setup.step = 0;
   auto plan = planOf(subject, request, job);
   if (!plan)
      return plan.error();
   AccuracyRuns runs(subject, *std::move(plan));
   if (const Status planned = runs.plan(job); !planned)
      return planned.error();
   if (const Status ran = runs.runAll(job); !ran)
      return ran.error();
   AccuracyStudy study = judgeRuns(runs);
   study.scene = design.name;
   if (!isStill(study.quantity)) {
      const auto sensitivity = sensitivityOf(subject, runs.request(), job);
      if (!sensitivity)
         return sensitivity.error();
      study.sensitivity = *sensitivity;
      if (*sensitivity > kChaotic)
         study.notes.push_back(fmt::format(
             "chaos: a change of density by one part in 10^9 changes the result by {:.2g} parts in 10^9, so "
             "that no setting can be more accurate than what the scene is known to",
             *sensitivity));
   }
   return study;
}

} // namespace diatom
