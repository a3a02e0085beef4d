// Motion in time, one bond at a time, of whatever a scene calls for: net force of every cell and the
// integrators. Absent effects are compiled out of the loops.
#pragma once

#include "explicit/forces.h"
#include "explicit/motion.h"
#include "model/contact.h"

namespace bonds {

class Dynamics : public Motion
{
public:
   Dynamics(const sdk::SceneView &scene, const Assembly &assembly, const Couplings &couplings,
            const Options &options);

   Moving moving() const override;
   void save(double time) override;
   double restore() override;
   std::string how() const override { return "scalar code, f64"; }

private:
   void advance(const sdk::Call &call, double time, double dt) override;
   enum class Phase { kickDrift, halfDrift, predict, kickHalfDrift, stage };
   /// A stage of a step, in seconds where stages.h has parts of it.
   struct StageOfStep
   {
      bool first, last;
      double ahead, next, weight;
   };
   template<unsigned Effects>
   void piece(Phase phase, double dt, const StageOfStep &stage, std::int64_t begin, std::int64_t end,
              Sums &sums);
   template<unsigned Effects>
   void net(std::int64_t i, double ahead, double weight, Vec3 &force, Vec3 &torque, Sums &sums);
   void drift(std::int64_t i, double dt);
   void stageCell(std::int64_t i, double dt, const StageOfStep &stage, Vec3 force, Vec3 torque);
   void cells(const sdk::Call &call, Phase phase, double dt, const StageOfStep &stage = {});
   void bondForces(const sdk::Call &call, double weight);
   void countDrive(double time);
   void semiImplicit(const sdk::Call &call, double time, double dt);
   void verlet(const sdk::Call &call, double time, double dt);
   void inStages(const sdk::Call &call, double time, double dt);

   using Piece = void (Dynamics::*)(Phase, double, const StageOfStep &, std::int64_t, std::int64_t, Sums &);
   using Net = void (Dynamics::*)(std::int64_t, double, double, Vec3 &, Vec3 &, Sums &);
   template<unsigned... Effects>
   void select(unsigned effects, std::integer_sequence<unsigned, Effects...>);

   BondForcesPass m_bonds;
   CellForces m_between; // what couplings exert; empty columns without any
   Piece m_piece;
   Net m_net;
   Column m_start, m_sum; // of stages: 13 per cell; of Verlet with damping: velocities
   std::vector<Sums> m_sums;
};

} // namespace bonds
