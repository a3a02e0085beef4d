// The analysis "dynamics" by implicit steps: their length is set by the motion, not by the stiffest bond.
#pragma once

#include "analysis.h"
#include "equilibrium/readout.h"
#include "implicit/implicit_motion.h"

namespace bonds {

class ImplicitRun : public Analysis
{
public:
   static void estimate(const Options &options, const sdk::SceneView &scene, diatom_estimate &estimate);

   ImplicitRun(const Options &options, const sdk::Values &values, const sdk::SceneView &scene);
   ImplicitRun(const ImplicitRun &) = delete;
   ImplicitRun &operator=(const ImplicitRun &) = delete;

   void apply(const sdk::Call &call, std::span<const diatom_channel> channels) override;
   std::int32_t step(const sdk::Call &call, const diatom_step_request &request,
                     diatom_step_result &result) override;
   const diatom_outputs &outputs() const override { return m_readout.outputs(); }
   void read(std::int64_t output, std::int64_t first, std::int64_t count, double *values) const override;

private:
   ImplicitMotion::End advance(const sdk::Call &call, const diatom_step_request &request, double step);
   bool grown();
   /// Keeps the last good state: before energy came from nowhere.
   void reportFailure(const sdk::Call &call, double step, diatom_step_result &result);

   Balance m_balance;
   ImplicitMotion m_motion;
   Readout m_readout;
   // J: stored at the start; what a growth is held against: in motion at the start, most gone in since
   double m_start = 0, m_scale = 0, m_most = 0;
   bool m_failed = false;
   ImplicitMotion::Moment m_good; // the last that was looked at and had not grown
};

} // namespace bonds
