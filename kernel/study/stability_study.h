// Hard cases, each held against bounds that were set before: does a run stay bounded, keep its energy and
// momentum, come to rest, and stop in time where it cannot.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "plugins/catalogue.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace diatom {

/// One number of a run, which must not exceed its bound.
struct StabilityCheck
{
   std::string what;
   double measured = 0, bound = 0; // in the same unit, which `what` tells
   std::string why;                // where the bound comes from
   bool holds() const;             // false for what is not a number
};

struct StabilityRow
{
   std::string id;    // kebab-case
   std::string scene; // one line for people
   std::string how;   // integrator, step, precision
   std::int64_t cells = 0, steps = 0;
   double seconds = 0; // wall time
   std::vector<StabilityCheck> checks;
   std::string failure; // why it could not be run to its end; "" = it was
   bool holds() const;
};

struct StabilityStudy
{
   bool longForm = false;
   std::vector<StabilityRow> rows;
   bool holds() const;
};

struct StabilityRequest
{
   /// Up to 10^6 steps and 28^3 cells (minutes); otherwise the same rows with fewer steps and cells
   /// (seconds).
   bool longForm = false;
   std::vector<std::string> rows; // ids; empty = all
};

/// Ids of all rows with their scenes, in order.
std::vector<std::pair<std::string, std::string>> stabilityRows();

/// A row that cannot be run counts as not held, with the reason. Errors: cancelled; an id that no row has.
Result<StabilityStudy> studyStability(const std::shared_ptr<const Catalogue> &catalogue,
                                      const StabilityRequest &request, const Job &job);

std::string stabilityCsv(const StabilityStudy &study);
nlohmann::ordered_json stabilityJson(const StabilityStudy &study);
/// The table as a page of its own.
std::string stabilityMarkdown(const StabilityStudy &study);

} // namespace diatom
