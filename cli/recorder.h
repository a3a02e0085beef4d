// What a simulation leaves behind: a table of probes and energies over time, and the final state of every
// cell.
#pragma once

#include "core/file.h"
#include "core/job.h"
#include "core/result.h"
#include "scene/simulation.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace diatom::cli {

/// One channel of one cell: "X,Y,Z:CHANNEL".
struct Probe
{
   std::string name;
   std::int64_t cell = -1;
   std::string channel, unit;
};

Result<Probe> parseProbe(const std::string &text, const Scene &scene);

/// Writes CSV rows; the file appears only with finish().
class Recorder
{
public:
   Recorder(const std::filesystem::path &file, std::vector<Probe> probes);
   Status row(const Simulation &simulation, const Job &job);
   /// `mark` is written as a last comment line when the run did not come to its end.
   Status finish(std::string_view mark);

private:
   AtomicFile m_file;
   std::vector<Probe> m_probes;
};

/// Index, material, position, rotation, velocities and strain of every cell: CSV, or JSON lines for other
/// suffixes.
Status writeState(const Simulation &simulation, const Model &model, const std::filesystem::path &file,
                  const Job &job);

} // namespace diatom::cli
