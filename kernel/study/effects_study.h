// What each effect costs in a step, and that one which a scene does not call for costs nothing.
#pragma once

#include "core/job.h"
#include "document/design.h"
#include "plugins/catalogue.h"

#include <nlohmann/json.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace diatom {

/// A scene against the same scene without the effect.
struct EffectTiming
{
   double ratio = 1; // of the time of a step: median over turns in which both were run
   bool sameBits = false;
};

struct EffectRow
{
   std::string effect, scene;
   std::int64_t cells = 0;
   double without = 0;                   // ns per cell-step of a scene that has nothing of it
   std::optional<EffectTiming> ruledOut; // the scene has it, and it is switched off
   std::optional<EffectTiming> forcedOn; // nothing in the scene calls for it, and it is switched on
   std::optional<double> calledFor;      // ns per cell-step of the scene that calls for it
   std::string note;                     // why something could not be run

   /// ns per cell-step that the effect adds.
   std::optional<double> cost() const;
};

struct EffectsStudy
{
   std::vector<EffectRow> rows;
   double seconds = 0;
};

struct EffectsRequest
{
   int turns = 15;            // in each of which all variants of a scene are run
   double turnSeconds = 0.02; // of each variant
};

/// Over scenes of its own, each a block of cells that lacks, has, or has only to have switched on or off one
/// effect. Errors: cancelled; the solver is missing.
Result<EffectsStudy> studyEffects(const std::shared_ptr<const Catalogue> &catalogue,
                                  const EffectsRequest &request, const Job &job);
/// Over a design: each effect that it calls for and that can be switched off.
Result<EffectsStudy> studyEffectsOf(const std::shared_ptr<const Catalogue> &catalogue, const Design &design,
                                    const EffectsRequest &request, const Job &job);

std::string effectsCsv(const EffectsStudy &study);
nlohmann::ordered_json effectsJson(const EffectsStudy &study);

} // namespace diatom
