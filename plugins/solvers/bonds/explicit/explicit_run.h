// Motion in time by explicit steps: a step that is known to be stable, a watch for divergence, outputs.
#pragma once

#include "analysis.h"
#include "explicit/motion.h"

#include "model/energy.h"
#include "model/stable_step.h"

#include <optional>

namespace bonds {

class ExplicitRun : public Analysis
{
public:
   static void estimate(const sdk::Call &call, const Options &options, const sdk::SceneView &scene,
                        diatom_estimate &estimate);

   ExplicitRun(const sdk::Call &call, const Options &options, const sdk::SceneView &scene);
   ExplicitRun(const ExplicitRun &) = delete;
   ExplicitRun &operator=(const ExplicitRun &) = delete;

   /// How the motion is computed and, where that is the slow way, why.
   std::string how() const;
   void apply(const sdk::Call &call, std::span<const diatom_channel> channels) override;
   std::int32_t step(const sdk::Call &call, const diatom_step_request &request,
                     diatom_step_result &result) override;
   const diatom_outputs &outputs() const override { return m_outputs; }
   void read(std::int64_t output, std::int64_t first, std::int64_t count, double *values) const override;

private:
   double chooseStep(const diatom_step_request &request) const;
   Energies energiesNow() const
   {
      return energies(m_assembly, m_couplings, m_motion->state(), m_motion->rest());
   }
   const Acting &acting() const;
   bool diverged();
   std::string whereText(std::int64_t bond, std::int64_t cell) const;
   void warnOfLargeTurns(const sdk::Call &call, bool last);
   void reportDivergence(const sdk::Call &call, double time, double step, diatom_step_result &result);

   Options m_options;
   Assembly m_assembly;
   Couplings m_couplings;
   std::vector<std::array<std::int32_t, 3>> m_index; // of cells, for messages
   std::unique_ptr<Motion> m_motion;
   StableStep m_stable;
   double m_time = 0;
   double m_balance = 0;                       // J: stored + dissipated - work at the start
   double m_scale = 0, m_work = 0, m_fall = 0; // J: what has gone in so far
   std::int64_t m_sinceCheck = 0, m_sinceLook = 0;
   bool m_failed = false, m_warned = false;
   mutable std::optional<Acting> m_acting; // of the present moment, once asked for
   std::array<diatom_output, 9> m_output;
   diatom_outputs m_outputs{};
};

} // namespace bonds
