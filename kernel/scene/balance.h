// The static balance of a scene, and what its supports supply.
#pragma once

#include "core/vec.h"
#include "scene/solver_run.h"

#include <memory>
#include <optional>
#include <vector>

namespace diatom {

struct BalanceRequest
{
   /// s, at which curves and signals are taken; without one the last time of any curve, 0 without curves.
   std::optional<double> time;
   /// Largest unbalanced force over the largest force at work. Newton converges quadratically, so that asking
   /// for less accuracy saves at most an iteration; rounding of a stiff scene lies some orders below.
   double tolerance = 1e-8;
};

struct Balance
{
   std::unique_ptr<SolverRun> run; // outputs are those of the balance
   double residual = 0;            // reached, in the measure of BalanceRequest::tolerance
   std::int64_t iterations = 0;    // of Newton's method, over all load steps
};

/// The scene is built for Analysis::statics; `values` override the set-up's solver values. Errors: what
/// SolverRun::create() refuses; ErrorCode::unstable with place and remedy where no balance was found;
/// cancelled.
Result<Balance> solveStatics(std::shared_ptr<const Catalogue> catalogue, std::unique_ptr<Scene> scene,
                             const Setup &setup, const Values &values, const BalanceRequest &request,
                             const Job &job);

/// The balance at another time, found from the one that is there; on failure that one stays readable.
Status rebalance(Balance &balance, double time, double tolerance, const Job &job);

/// Force and moment about the origin, world axes.
struct Wrench
{
   Vec3 force = Vec3::Zero();  // N
   Vec3 moment = Vec3::Zero(); // N m
};

/// What supports and drives supply to the scene as it is now. A cell of several entries counts in each, and
/// once in the total.
struct Reactions
{
   std::vector<Wrench> supports, drives; // in the set-up's order
   Wrench driven;                        // of all cells that some drive is on
   Wrench total;
};

/// Errors: the solver does not tell reactions.
Result<Reactions> reactionsOf(const SolverRun &run, const Setup &setup, const Job &job);

/// Loads and weight, where the cells are now: what the total of reactions balances, unless a ground helps.
Result<Wrench> loadsOn(const SolverRun &run, const Job &job);

/// Asks the solver until it says that it is done, as solveStatics() and findModes() do; `what` is sought.
Status settle(SolverRun &run, const diatom_step_request &request, const char *what, double &residual,
              std::int64_t &iterations, const Job &job);

/// The last time of any curve of the set-up, 0 without curves.
double endOfCurves(const Setup &setup);

} // namespace diatom
