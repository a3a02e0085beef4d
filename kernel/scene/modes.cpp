#include "scene/modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace diatom {

namespace {

/// The last place of the scene's largest eigenvalue, which is 4 over the square of the largest stable step of
/// central differences.
double lastPlaceOf(const SolverRun &run, const std::vector<double> &eigenvalues)
{
   const double step = run.estimate().stable_step;
   if (step > 0 && std::isfinite(step))
      return std::numeric_limits<double>::epsilon() * 4 / (step * step);
   double most = 0; // the solver gives no step: all that is known is what was found
   for (const double value : eigenvalues)
      most = std::max(most, std::abs(value));
   return 1e-12 * most;
}

} // namespace

Mode modeOf(double eigenvalue, double lastPlace)
{
   // A slender body's true frequencies may lie close above rounding, and to lose one is worse than to show a
   // free motion with next to none; below zero there is nothing to lose.
   constexpr double kPlacesBelow = 1e3;
   if (eigenvalue <= lastPlace && eigenvalue >= -kPlacesBelow * lastPlace)
      return {Mode::Kind::neutral, eigenvalue, 0};
   if (eigenvalue < 0)
      return {Mode::Kind::unstable, eigenvalue, 0};
   return {Mode::Kind::vibration, eigenvalue, std::sqrt(eigenvalue) / (2 * std::numbers::pi)};
}

Result<std::vector<double>> Modes::shape(std::size_t mode, const Job &job) const
{
   const std::int64_t cells = run->scene().cells();
   auto rows = run->read("mode", static_cast<std::int64_t>(mode) * cells, cells, job);
   if (rows && rows->size() != 6 * static_cast<std::size_t>(cells))
      return Error{ErrorCode::internal,
                   fmt::format("{}: its output 'mode' must have 6 numbers for each cell", run->solver())};
   return rows;
}

Result<Modes> findModes(std::shared_ptr<const Catalogue> catalogue, std::unique_ptr<Scene> scene,
                        const Setup &setup, const Values &values, const BalanceRequest &request,
                        const Job &job)
{
   if (scene->analysis() != Analysis::modes)
      return Error{ErrorCode::internal, "the scene was built for another analysis than modes"};
   auto run = SolverRun::create(std::move(catalogue), std::move(scene), setup, values, job);
   if (!run)
      return run.error();
   Modes found{*std::move(run), {}, 0, 0};
   const diatom_step_request asked{sizeof(diatom_step_request), request.time.value_or(endOfCurves(setup)), 0,
                                   std::numeric_limits<std::int64_t>::max(), request.tolerance};
   if (const Status settled =
           settle(*found.run, asked, "modes about a static balance", found.residual, found.iterations, job);
       !settled)
      return settled.error();
   const auto eigenvalues = found.run->output("eigenvalue", job);
   if (!eigenvalues)
      return eigenvalues.error();
   const double lastPlace = lastPlaceOf(*found.run, *eigenvalues);
   for (const double value : *eigenvalues)
      found.modes.push_back(modeOf(value, lastPlace));
   return found;
}

} // namespace diatom
