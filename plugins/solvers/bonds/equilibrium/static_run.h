// The analysis "statics": the balance under loads, signals and curves as they are at a time.
#pragma once

#include "analysis.h"
#include "equilibrium/readout.h"
#include "equilibrium/statics.h"

namespace bonds {

class StaticRun : public Analysis
{
public:
   static void estimate(const Options &options, const sdk::SceneView &scene, diatom_estimate &estimate);

   StaticRun(const Options &options, const sdk::Values &values, const sdk::SceneView &scene);
   StaticRun(const StaticRun &) = delete;
   StaticRun &operator=(const StaticRun &) = delete;

   void apply(const sdk::Call &call, std::span<const diatom_channel> channels) override;
   std::int32_t step(const sdk::Call &call, const diatom_step_request &request,
                     diatom_step_result &result) override;
   const diatom_outputs &outputs() const override { return m_readout.outputs(); }
   void read(std::int64_t output, std::int64_t first, std::int64_t count, double *values) const override;

   /// Whether the state is a balance as it is; fills the result then.
   bool inBalance(const sdk::Call &call, const diatom_step_request &request, diatom_step_result &result);

   const Balance &balance() const { return m_balance; }
   Statics &statics() { return m_statics; }
   const State &state() const { return m_state; }

private:
   std::string failureText(const StaticsResult &result) const;
   void takeForces(const sdk::Call &call);

   Balance m_balance;
   State m_state;
   Statics m_statics;
   StaticsOptions m_options;
   Vector m_internal, m_reaction;
   double m_storedAtStart = 0; // J
   double m_time = 0;          // s, of the last balance
   Readout m_readout;
};

} // namespace bonds
