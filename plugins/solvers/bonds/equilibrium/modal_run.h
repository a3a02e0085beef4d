// The analysis "modes": the balance at a time, then the lowest or the highest vibrations about it.
#pragma once

#include "equilibrium/modes.h"
#include "equilibrium/static_run.h"

namespace bonds {

class ModalRun : public Analysis
{
public:
   static void estimate(const Options &options, const sdk::SceneView &scene, diatom_estimate &estimate);

   ModalRun(const Options &options, const sdk::Values &values, const sdk::SceneView &scene);
   ModalRun(const ModalRun &) = delete;
   ModalRun &operator=(const ModalRun &) = delete;

   void apply(const sdk::Call &call, std::span<const diatom_channel> channels) override;
   std::int32_t step(const sdk::Call &call, const diatom_step_request &request,
                     diatom_step_result &result) override;
   const diatom_outputs &outputs() const override { return m_readout.outputs(); }
   void read(std::int64_t output, std::int64_t first, std::int64_t count, double *values) const override;

private:
   std::int32_t findBalance(const sdk::Call &call, const diatom_step_request &request,
                            diatom_step_result &result);

   StaticRun m_static;
   std::int64_t m_wanted;
   bool m_highest;
   ModeShapes m_modes;
   Readout m_readout;
};

} // namespace bonds
