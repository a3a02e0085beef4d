// Motion in time: a solver plugin's instance on a scene, stepped, probed and recorded.
#pragma once

#include "core/vec.h"
#include "scene/solver_run.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace diatom {

struct Energy
{
   double kinetic = 0, elastic = 0, gravity = 0, contact = 0; // J, stored
   double dissipated = 0; // J, taken out by damping, drag and friction since the start
   double work = 0;       // J, put in by actuators, loads and supports since the start
   /// (stored now + dissipated - work - stored at the start) over the most energy seen in play, which is
   /// kinetic + elastic + contact + the change of gravity's; 0 when all is 0. Looked at after each batch of
   /// steps.
   double drift = 0;
};

struct Momentum
{
   Vec3 linear = Vec3::Zero();  // kg m/s
   Vec3 angular = Vec3::Zero(); // kg m2/s about the origin
};

/// One thread at a time.
class Simulation
{
public:
   /// `values` override the set-up's solver values (integrator, precision, beam, ...). The scene is built for
   /// Analysis::dynamics.
   static Result<std::unique_ptr<Simulation>> start(std::shared_ptr<const Catalogue> catalogue,
                                                    std::unique_ptr<Scene> scene, const Setup &setup,
                                                    const Values &values, const Job &job);
   ~Simulation();

   const SolverRun &run() const;
   const Scene &scene() const;
   double time() const; // s
   std::int64_t steps() const;
   double step() const;       // s, the step in use
   double stableStep() const; // s, the largest stable one
   std::int64_t stableLink() const;
   double wallSeconds() const; // spent stepping

   /// Time that progress is told against, where advance() is called in pieces.
   void setGoal(double time);
   /// Steps until `until` (s), or so far on the way there as `most` steps lead; 0 = all the way. On
   /// divergence: ErrorCode::unstable with bond, time and remedy; the last good state stays readable. On
   /// cancel: ErrorCode::cancelled, likewise.
   Status advance(double until, const Job &job, std::int64_t most = 0);
   Result<Energy> energy(const Job &job) const;
   Result<Momentum> momentum(const Job &job) const;
   Result<Frame> frame(const Job &job) const;
   /// One named channel of one cell: x y z (displacement, m), vx vy vz, rx ry rz (rotation vector, rad),
   /// strain, fx fy fz mx my mz (what its supports supply, where the solver tells).
   Result<double> probe(std::int64_t cell, const std::string &channel, const Job &job) const;
   /// All rows of one of the solver's own outputs ("velocity", "strain", ...), stride numbers per cell.
   Result<std::vector<double>> output(const std::string &name, const Job &job) const;

   /// The channels probe() knows, with their units.
   static std::vector<std::pair<std::string, std::string>> probeChannels();

private:
   Simulation();
   struct Self;
   std::unique_ptr<Self> m_self;
};

} // namespace diatom
