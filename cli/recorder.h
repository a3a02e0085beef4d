// What a run leaves behind: a table of probes and energies over time, and the final state of every
// cell.
#pragma once

#include "core/file.h"
#include "core/job.h"
#include "core/result.h"
#include "scene/solver_run.h"

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

/// `ownOutputs`: of a solver of another physics than mechanics, whose channels are known once it runs.
Result<Probe> parseProbe(const std::string &text, const Scene &scene, bool ownOutputs = false);

/// Writes CSV rows; the file appears only with finish().
class Recorder
{
public:
   /// Energies are left out where the solver does not tell them; `more` are headings of further columns.
   Recorder(const std::filesystem::path &file, std::vector<Probe> probes, const SolverRun &run,
            const std::vector<std::string> &more = {});
   /// A row of the run's state, with the values of the further columns.
   Status row(const SolverRun &run, const Job &job, const std::vector<double> &more = {});
   /// `mark` is written as a last comment line when the run did not come to its end.
   Status finish(std::string_view mark);

private:
   AtomicFile m_file;
   std::vector<Probe> m_probes;
   bool m_energies;
};

/// Index, material, position, rotation, velocities, strain and reactions of every cell, as far as the solver
/// tells them, and what else it tells of every cell: CSV, or JSON lines for other suffixes.
Status writeState(const SolverRun &run, const Model &model, const std::filesystem::path &file,
                  const Job &job);

/// What the solver tells of every link, with the indices of its two cells, as CSV. Errors: it tells nothing
/// of links.
Status writeLinks(const SolverRun &run, const std::filesystem::path &file, const Job &job);

} // namespace diatom::cli
