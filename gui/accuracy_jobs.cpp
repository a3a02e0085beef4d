#include "gui/accuracy_jobs.h"

#include "core/clock.h"
#include "study/motion_time.h"

#include <chrono>

namespace diatom::gui {

namespace {

constexpr double kLookSeconds = 1;   // of wall time to see the design move
constexpr double kUsualLength = 1;   // s
constexpr double kChoiceBudget = 10; // s of wall time for each setting that is considered

} // namespace

Result<double> lengthToProbe(const Subject &subject, const Job &job)
{
   if (subject.setup.until > 0)
      return subject.setup.until;
   const auto start = Clock::now();
   Job *self = nullptr;
   Job limited([&](double, std::string_view) {
      const std::chrono::duration<double> spent = Clock::now() - start;
      if (job.cancelled() || spent.count() > kLookSeconds)
         self->cancel();
   });
   self = &limited;
   limited.setThreads(job.threads());
   auto seen = motionTime(subject, limited);
   if (!seen && seen.error().code == ErrorCode::cancelled && !job.cancelled())
      return kUsualLength;
   return seen;
}

Result<AccuracyProbe> probeDesign(const Subject &subject, const Job &job)
{
   const auto until = lengthToProbe(subject, job);
   if (!until)
      return until.error();
   ProbeRequest request;
   request.until = *until;
   return probeAccuracy(subject, request, job);
}

Result<AccuracyChoice> chooseForDesign(const Subject &subject, double error, const Job &job)
{
   const auto until = lengthToProbe(subject, job);
   if (!until)
      return until.error();
   ChoiceRequest request;
   request.until = *until;
   request.error = error;
   request.budget = kChoiceBudget;
   return chooseForAccuracy(subject, request, job);
}

bool sameButStep(const Setup &a, const Setup &b)
{
   Setup like = a;
   like.step = b.step;
   like.references = b.references;
   return like == b;
}

} // namespace diatom::gui
