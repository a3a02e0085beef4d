// A solver plugin's instance on a scene, and what can be read from it: what motion, balance and modes share.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "plugins/catalogue.h"
#include "scene/scene.h"

#include <diatom/abi/solver.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace diatom {

/// Pose of every cell for drawing: 3 doubles position (m) and 4 quaternion (w x y z, turn since rest) each.
struct Frame
{
   double time = 0;
   std::vector<double> position, rotation;
};

/// What a solver is about: "mechanics", "electronics", or another word of its author's.
Result<std::vector<std::string>> solverPhysics(const Catalogue &catalogue, const std::string &solver,
                                               const Job &job);
constexpr const char *kMechanics = "mechanics";

/// One thread at a time.
class SolverRun
{
public:
   /// Makes the solver for the scene's analysis; `values` override the set-up's solver values. Errors: the
   /// solver has not this analysis or not an effect that the scene calls for, or refuses the scene.
   static Result<std::unique_ptr<SolverRun>> create(std::shared_ptr<const Catalogue> catalogue,
                                                    std::unique_ptr<Scene> scene, const Setup &setup,
                                                    const Values &values, const Job &job);
   SolverRun(const SolverRun &) = delete;
   SolverRun &operator=(const SolverRun &) = delete;

   const Scene &scene() const { return *m_scene; }
   const std::string &solver() const { return m_solver->id(); }
   const diatom_estimate &estimate() const { return m_estimate; }
   double time() const { return m_time; } // s, of the state that is read

   /// One call of the solver's step; what it did is in `result` also where it was cancelled.
   Status step(const diatom_step_request &request, diatom_step_result &result, const Job &job);
   double wallSeconds() const { return m_wall; } // spent in step()

   bool hasOutput(const std::string &name) const { return m_outputs.contains(name); }
   /// Rows of an output; 0 when there is none of that name.
   std::int64_t rows(const std::string &name) const;
   /// `count` rows of an output from row `first`, stride numbers each.
   Result<std::vector<double>> read(const std::string &name, std::int64_t first, std::int64_t count,
                                    const Job &job) const;
   /// What the solver tells, in its order. Outputs whose names begin with link_ have a row for each link of
   /// the scene.
   struct Told
   {
      std::string name, unit;
      std::int64_t rows = 0, stride = 0;
   };
   std::vector<Told> told() const;
   /// Whether it is about motion and forces: what cannot be said of other physics then can.
   bool mechanics() const { return m_mechanics; }
   /// All rows of an output.
   Result<std::vector<double>> output(const std::string &name, const Job &job) const;
   Result<Frame> frame(const Job &job) const;
   /// One channel of probeChannels() of one cell: displacements, turns and speeds, strain, and what the
   /// cell's supports supply; or an output of the solver's own with a row for each cell: its name, with .0,
   /// .1 and so on where a row has several numbers.
   Result<double> probe(std::int64_t cell, const std::string &channel, const Job &job) const;
   /// "in the bond between cells (0, 0, 0) and (1, 0, 0)", "at cell ...", "somewhere".
   std::string placeOf(const diatom_step_result &result) const;

   /// The channels probe() knows, with their units.
   static std::vector<std::pair<std::string, std::string>> probeChannels();

private:
   SolverRun() = default;
   Status listOutputs(const Job &job);
   Error broken(const char *function, const std::string &fault) const;

   struct Output
   {
      std::int64_t number = 0, rows = 0, stride = 0;
      std::string unit;
   };
   std::shared_ptr<const Catalogue> m_catalogue;
   std::unique_ptr<Scene> m_scene; // outlives the solver, which may point into it while it is made
   std::shared_ptr<const Instance> m_solver;
   std::map<std::string, Output> m_outputs;
   diatom_estimate m_estimate{};
   double m_time = 0, m_wall = 0;
   bool m_mechanics = true;
};

} // namespace diatom
