// The solver as the host sees it: it picks the analysis that the scene asks for and passes every call on.
#pragma once

#include "analysis.h"

namespace bonds {

class BondsSolver
{
public:
   static const diatom_capabilities &capabilities();
   static void estimate(sdk::Call call, sdk::Values values, const sdk::SceneView &scene,
                        diatom_estimate &estimate);

   BondsSolver(sdk::Call call, sdk::Values values, const sdk::SceneView &scene);

   void apply(sdk::Call call, std::span<const diatom_channel> channels) { m_analysis->apply(call, channels); }
   std::int32_t step(sdk::Call call, const diatom_step_request &request, diatom_step_result &result)
   {
      return m_analysis->step(call, request, result);
   }
   const diatom_outputs &outputs() const { return m_analysis->outputs(); }
   void read(sdk::Call, std::int64_t output, std::int64_t first, std::int64_t count, double *values) const
   {
      m_analysis->read(output, first, count, values);
   }

private:
   std::unique_ptr<Analysis> m_analysis;
};

} // namespace bonds
