// What the solver can be asked: a way of answering a scene, chosen when the solver is made.
#pragma once

#include "model/assembly.h"

#include <span>

namespace bonds {

/// The table of diatom.solver/1 as a class; one call at a time.
class Analysis
{
public:
   virtual ~Analysis() = default;
   /// New loads, supports or signals; throws Failure(DIATOM_UNSUPPORTED) for "make a new solver".
   virtual void apply(const sdk::Call &call, std::span<const diatom_channel> channels) = 0;
   virtual std::int32_t step(const sdk::Call &call, const diatom_step_request &request,
                             diatom_step_result &result) = 0;
   virtual const diatom_outputs &outputs() const = 0;
   /// Rows [first, first + count) of an output, known to exist.
   virtual void read(std::int64_t output, std::int64_t first, std::int64_t count, double *values) const = 0;
};

} // namespace bonds
