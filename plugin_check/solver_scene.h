// Scenes that a solver is tried on: the author's designs, and small ones of mechanics that have known
// answers.
#pragma once

#include "document/design.h"
#include "plugin_check/findings.h"
#include "plugin_check/subject.h"
#include "scene/scene.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace diatom::check {

/// What the solver says of itself, copied.
struct Abilities
{
   std::vector<std::string> physics, analyses, effects, lattices;
   bool deterministic = false;

   bool has(const std::vector<std::string> &list, const std::string &word) const;
   bool mechanics() const { return has(physics, "mechanics"); }
   bool can(Analysis analysis) const { return has(analyses, analysisName(analysis)); }
};
Result<Abilities> abilitiesOf(const Subject &subject);

struct Trial
{
   std::string label;
   Design design;
   Analysis analysis = Analysis::dynamics;

   /// A new one each time: a solver's run keeps it.
   Result<std::unique_ptr<Scene>> scene(const Subject &subject) const;
};

/// Every analysis of the solver on every scene for it; why there is none, as a finding.
std::vector<Trial> trialsFor(const Subject &subject, const Abilities &can, Findings &findings);

/// A bar of cubes along x, `length` cells of 1 mm long and `width` thick, its first layer held.
Design barDesign(const Subject &subject, int length, int width);
constexpr double kBarPitch = 1e-3, kBarModulus = 1e7, kBarDensity = 1000; // m, Pa, kg/m3

/// All outputs of a run, by name.
using Answers = std::map<std::string, std::vector<double>>;
struct RunOptions
{
   int threads = 1;
   bool isolated = false; // in the worker
   Values values;
};
/// Runs the trial for a moment (motion), or to its end.
Result<Answers> runTrial(const Subject &subject, const Trial &trial, const RunOptions &options);

/// So many steps, for as long as they take; and where what they did is written.
inline diatom_step_request requestOf(std::int64_t steps)
{
   return {sizeof(diatom_step_request), 1e9, 0, steps, 0};
}
inline diatom_step_result emptyResult()
{
   return {sizeof(diatom_step_result), DIATOM_RUNNING, 0, 0, 0, -1, -1, 0, 0};
}

/// Answers of mechanics that are known beforehand: tension, free fall, an undamped swing.
void checkSolverKnown(const Subject &subject, Findings &findings);

} // namespace diatom::check
