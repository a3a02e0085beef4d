// The solver as the host sees it: stepping with a step that is known to be stable, a watch for divergence,
// outputs.
#pragma once

#include "energy.h"
#include "stable_step.h"

namespace bonds {

class BondsSolver
{
public:
   static const diatom_capabilities &capabilities();
   static void estimate(sdk::Call call, sdk::Values values, const sdk::SceneView &scene,
                        diatom_estimate &estimate);

   BondsSolver(sdk::Call call, sdk::Values values, const sdk::SceneView &scene);
   BondsSolver(const BondsSolver &) = delete;
   BondsSolver &operator=(const BondsSolver &) = delete;

   void apply(sdk::Call call, std::span<const diatom_channel> channels);
   std::int32_t step(sdk::Call call, const diatom_step_request &request, diatom_step_result &result);
   const diatom_outputs &outputs() const { return m_outputs; }
   void read(sdk::Call call, std::int64_t output, std::int64_t first, std::int64_t count,
             double *values) const;

private:
   double chooseStep(const diatom_step_request &request) const;
   bool diverged();
   std::string whereText(std::int64_t bond, std::int64_t cell) const;
   void reportDivergence(const sdk::Call &call, double time, double step, diatom_step_result &result);

   Options m_options;
   Assembly m_assembly;
   std::vector<std::array<std::int32_t, 3>> m_index; // of cells, for messages
   Dynamics m_dynamics;
   StableStep m_stable;
   Dynamics::Snapshot m_good;
   double m_time = 0;
   double m_balance = 0;                       // J: stored + dissipated - work at the start
   double m_scale = 0, m_work = 0, m_fall = 0; // J: what has gone in so far
   std::int64_t m_sinceCheck = 0;
   bool m_failed = false;
   std::array<diatom_output, 7> m_output;
   diatom_outputs m_outputs{};
};

} // namespace bonds
