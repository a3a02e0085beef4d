#include "scene/balance.h"

#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

namespace diatom {

namespace {

/// All rows of an output that has `stride` numbers for each cell.
Result<std::vector<double>> rowsOf(const SolverRun &run, const char *name, std::size_t stride, const Job &job)
{
   auto rows = run.output(name, job);
   if (rows && rows->size() != stride * static_cast<std::size_t>(run.scene().cells()))
      return Error{ErrorCode::internal, fmt::format("{}: its output '{}' must have {} numbers for each cell",
                                                    run.solver(), name, stride)};
   return rows;
}

/// Adds a force and a moment (six numbers) that act at a point.
void addAt(Wrench &sum, const double *six, const double *point)
{
   const Eigen::Map<const Vec3> force(six), moment(six + 3), at(point);
   sum.force += force;
   sum.moment += moment + at.cross(force);
}

const diatom_channel *channelOf(const diatom_scene &scene, std::string_view name)
{
   for (std::int64_t k = 0; k < scene.channels; ++k)
      if (name == scene.channel[k].name)
         return &scene.channel[k];
   return nullptr;
}

/// The column of materials' properties by this name; -1 without one.
std::int64_t columnOf(const diatom_scene &scene, std::string_view name)
{
   for (std::int32_t k = 0; k < scene.properties; ++k)
      if (name == scene.property_name[k])
         return k;
   return -1;
}

} // namespace

double endOfCurves(const Setup &setup)
{
   double end = 0;
   for (const Drive &drive : setup.drives)
      if (!drive.curve.empty())
         end = std::max(end, drive.curve.back().time);
   return end;
}

Status settle(SolverRun &run, const diatom_step_request &request, const char *what, double &residual,
              std::int64_t &iterations, const Job &job)
{
   for (;;) {
      if (job.cancelled())
         return Error{ErrorCode::cancelled, fmt::format("cancelled while seeking {}", what)};
      diatom_step_result result{sizeof(diatom_step_result), DIATOM_RUNNING, 0, run.time(), 0, -1, -1, 0, 0};
      const Status stepped = run.step(request, result, job);
      iterations += result.iterations;
      residual = result.residual;
      if (!stepped)
         return stepped.error().code == ErrorCode::cancelled
                    ? Error{ErrorCode::cancelled, fmt::format("cancelled while seeking {}", what)}
                    : stepped.error();
      if (result.state == DIATOM_DIVERGED && !run.mechanics())
         return Error{
             ErrorCode::unstable,
             fmt::format(
                 "{} was not found: after {} iterations {} is left of what drives it{}; look at what is "
                 "set there, or ask for less with --tolerance",
                 what, iterations, numberText(residual),
                 result.bad_cell < 0 && result.bad_link < 0 ? "" : ", most " + run.placeOf(result))};
      if (result.state == DIATOM_DIVERGED)
         return Error{ErrorCode::unstable,
                      fmt::format("{} was not found: after {} iterations the unbalanced force is {} of the "
                                  "forces at work{}; support what is loose, lower the loads, or take "
                                  "more load steps (--set solver.load_steps=20)",
                                  what, iterations, numberText(residual),
                                  result.bad_cell < 0 && result.bad_link < 0
                                      ? ""
                                      : ", largest " + run.placeOf(result))};
      if (result.state == DIATOM_CONVERGED || result.state == DIATOM_DONE)
         return {};
      if (result.steps <= 0 && result.iterations <= 0)
         return Error{ErrorCode::internal,
                      fmt::format("{} stopped seeking {} without saying why", run.solver(), what)};
   }
}

Result<Balance> solveStatics(std::shared_ptr<const Catalogue> catalogue, std::unique_ptr<Scene> scene,
                             const Setup &setup, const Values &values, const BalanceRequest &request,
                             const Job &job)
{
   if (scene->analysis() != Analysis::statics)
      return Error{ErrorCode::internal, "the scene was built for another analysis than statics"};
   auto run = SolverRun::create(std::move(catalogue), std::move(scene), setup, values, job);
   if (!run)
      return run.error();
   Balance balance{*std::move(run), 0, 0};
   const double time = request.time.value_or(endOfCurves(setup));
   if (const Status found = rebalance(balance, time, request.tolerance, job); !found)
      return found.error();
   return balance;
}

Status rebalance(Balance &balance, double time, double tolerance, const Job &job)
{
   const diatom_step_request asked{sizeof(diatom_step_request), time, 0,
                                   std::numeric_limits<std::int64_t>::max(), tolerance};
   return settle(*balance.run, asked, balance.run->mechanics() ? "a static balance" : "a steady state",
                 balance.residual, balance.iterations, job);
}

Result<Reactions> reactionsOf(const SolverRun &run, const Setup &setup, const Job &job)
{
   const auto reaction = rowsOf(run, "reaction", 6, job);
   if (!reaction)
      return reaction.error();
   const auto position = rowsOf(run, "position", 3, job);
   if (!position)
      return position.error();
   const auto add = [&](Wrench &sum, std::int64_t cell) {
      addAt(sum, reaction->data() + 6 * cell, position->data() + 3 * cell);
   };
   const auto sumOf = [&](const Where &where) {
      Wrench sum;
      for (const std::int64_t cell : run.scene().cellsIn(where))
         add(sum, cell);
      return sum;
   };
   std::vector<bool> driven(static_cast<std::size_t>(run.scene().cells()), false);
   Reactions all;
   for (const Support &support : setup.supports)
      all.supports.push_back(sumOf(support.where));
   for (const Drive &drive : setup.drives) {
      all.drives.push_back(sumOf(drive.where));
      for (const std::int64_t cell : run.scene().cellsIn(drive.where))
         driven[static_cast<std::size_t>(cell)] = true;
   }
   for (std::int64_t cell = 0; cell < run.scene().cells(); ++cell) {
      add(all.total, cell);
      if (driven[static_cast<std::size_t>(cell)])
         add(all.driven, cell);
   }
   return all;
}

Result<Wrench> loadsOn(const SolverRun &run, const Job &job)
{
   const diatom_scene &scene = run.scene().view();
   const auto position = rowsOf(run, "position", 3, job);
   if (!position)
      return position.error();
   Wrench sum;
   if (const diatom_channel *force = channelOf(scene, "force"))
      for (std::int64_t row = 0; row < force->count; ++row)
         addAt(sum, force->values + 6 * row, position->data() + 3 * force->where[row]);
   const diatom_channel *gravity = channelOf(scene, "gravity");
   const std::int64_t density = columnOf(scene, "density");
   for (std::int64_t cell = 0; gravity && density >= 0 && cell < scene.cells; ++cell) {
      const double *properties =
          scene.property + static_cast<std::int64_t>(scene.cell_material[cell]) * scene.properties;
      const Eigen::Map<const Vec3> extent(scene.cell_extent + 3 * cell), pull(gravity->values);
      std::array<double, 6> weight{};
      Eigen::Map<Vec3>(weight.data()) = properties[density] * extent.prod() * pull;
      addAt(sum, weight.data(), position->data() + 3 * cell);
   }
   return sum;
}

} // namespace diatom
