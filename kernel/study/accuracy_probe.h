// What accuracy costs on the scene at hand, from short runs of it: error and time for a few step lengths, and
// the bond that limits the step. Never invents a number: each says how it is known.
#pragma once

#include "study/convergence.h"
#include "study/step_limit.h"
#include "study/trial.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

enum class Knowledge {
   measured,  // by a run of exactly this
   predicted, // from runs of something shorter or coarser, by a law that they were seen to follow
   unknown
};

/// A number and how it is known. `value` is 0 when unknown.
struct Estimate
{
   double value = 0;
   Knowledge how = Knowledge::unknown;
   std::string why; // one sentence: where it comes from, or why it is unknown
};

/// "measured", "predicted", "unknown".
std::string_view knowledgeText(Knowledge how);

struct ProbeRequest
{
   double until = 0; // s: the run whose cost is asked, from rest at time 0
   /// What the error is of; nothing = the cell that moves most, in the direction it moves most.
   std::optional<Quantity> quantity;
   double budget = 1; // s of wall time the probe may take, roughly
   /// Override the set-up's solver values.
   Values values;
};

struct PresetEstimate
{
   std::string name;
   double fraction = 0; // of the probe's base step
   double step = 0;     // s
   Estimate error;      // of the asked run, relative to the quantity's largest value
   Estimate seconds;    // the asked run takes (wall), on this machine
};

struct AccuracyProbe
{
   Quantity quantity;
   double scale = 0; // largest value of the quantity in the probe, what errors are relative to
   StepLimit limit;
   /// s: the stable step; where the solver has no limit, what it chooses for itself times four, at most a
   /// twentieth of the run.
   double base = 0;
   double until = 0;      // s, the asked run
   double errorUntil = 0; // s, the part of it that errors are of: until the quantity's time
   double window = 0;     // s, simulated by the probe: 0 < window <= errorUntil
   double step = 0;       // s: the runs were made at this, a half and a quarter of it
   /// Over the window, of those runs.
   Convergence convergence;
   /// How the error grows with the length of a run, error ~ time^growth; nothing when it could not be seen.
   std::optional<double> growth;
   double stepSeconds = 0; // wall time of one step, in stretches of many
   double nsPerCellStep = 0;
   double probeSeconds = 0; // wall time the probe itself took
   std::vector<PresetEstimate> presets;
};

struct Preset
{
   const char *name;
   double fraction; // of the stable step
   bool withHalf;   // run again at half the step, so that its own error is known
};

inline constexpr std::array<Preset, 4> kPresets{
    {{"Draft", 0.9, false}, {"Balanced", 0.6, false}, {"Fine", 0.25, false}, {"Reference", 0.1, true}}};

/// Runs the scene briefly. Errors: as a run's own; the quantity's cell missing; cancelled (within one step).
Result<AccuracyProbe> probeAccuracy(const Subject &subject, const ProbeRequest &request, const Job &job);

/// What the probe tells of another step (s) than those of the presets.
PresetEstimate estimateAt(const AccuracyProbe &probe, std::string name, double step);

/// The longest step (s), up to the coarsest one tried, at which the error is at most this: of the asked run,
/// or, where that is unknown, of the part that was tried. Nothing when the runs do not converge, or not that
/// far within reason.
std::optional<double> stepFor(const AccuracyProbe &probe, double error);

/// The cell and direction (x, y or z) that move most within `until` at the solver's own step.
Result<Quantity> busiestQuantity(const Subject &subject, const Values &values, double until, const Job &job);

} // namespace diatom
