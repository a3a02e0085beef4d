// What every analysis of a design can be told on the command line, whichever it is.
#pragma once

#include "cli/cli.h"
#include "cli/recorder.h"
#include "document/design.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace diatom::cli {

struct RunOptions
{
   std::string file, solver, beam, gradient, effects, record, state;
   std::vector<std::string> probes, settings;
};

/// FILE, --solver, --beam, --gradient, --effects and --set.
void addModelOptions(CLI::App &command, RunOptions &options);
/// Those, and --probe, --record and --state.
void addRunOptions(CLI::App &command, RunOptions &options);

/// The design with its set-up as the options change it, and its lattice; null after printing the error.
std::unique_ptr<Context::Input> openToRun(const RunOptions &options, Context &context,
                                          const std::function<Status(Design &)> &more = {});

/// Probes of a scene, in the order they were asked for; `ownOutputs`: as for parseProbe().
Result<std::vector<Probe>> parseProbes(const std::vector<std::string> &texts, const Scene &scene,
                                       bool ownOutputs = false);

/// Values of the probes by their name.
Result<nlohmann::ordered_json> probeValues(const SolverRun &run, const std::vector<Probe> &probes,
                                           const Job &job);

/// Effects as a list of objects, or for people a line each.
nlohmann::ordered_json effectsReport(const std::vector<Effect> &effects, bool json);

} // namespace diatom::cli
