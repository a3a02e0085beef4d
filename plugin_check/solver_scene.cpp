#include "plugin_check/solver_scene.h"

#include "formats/files.h"
#include "scene/balance.h"
#include "scene/solver_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace diatom::check {

namespace {

constexpr int kSteps = 40; // of motion

constexpr std::array kAnalyses{Analysis::dynamics, Analysis::statics, Analysis::modes};

std::vector<std::string> wordsOf(const char *const *words, std::int64_t count)
{
   std::vector<std::string> copied;
   for (std::int64_t i = 0; words && i < count; ++i)
      copied.emplace_back(words[i] ? words[i] : "");
   return copied;
}

} // namespace

bool Abilities::has(const std::vector<std::string> &list, const std::string &word) const
{
   return std::find(list.begin(), list.end(), word) != list.end();
}

Result<Abilities> abilitiesOf(const Subject &subject)
{
   const diatom_capabilities *record = nullptr;
   const std::string &id = subject.provided->id;
   const Status told = subject.catalogue->callWith(
       DIATOM_SOLVER_1, id, {}, "capabilities", Job(),
       [&](const void *table, const diatom_call *call, const diatom_create *) {
          return static_cast<const diatom_solver *>(table)->capabilities(call, id.c_str(), &record);
       });
   if (!told)
      return told.error();
   if (!record || !DIATOM_HAS(diatom_capabilities, record, deterministic))
      return Error{ErrorCode::internal, "its capabilities are missing or too short"};
   return Abilities{wordsOf(record->physics_name, record->physics),
                    wordsOf(record->analysis_name, record->analyses),
                    wordsOf(record->effect_name, record->effects), wordsOf(record->lattice, record->lattices),
                    record->deterministic == 1};
}

Result<std::unique_ptr<Scene>> Trial::scene(const Subject &subject) const
{
   const auto lattice = Lattice::make(*subject.catalogue, design.model.lattice, Job());
   if (!lattice)
      return lattice.error();
   return Scene::build(Hierarchy(*lattice, design.model), design.setup, Job(), analysis);
}

Design barDesign(const Subject &subject, int length, int width)
{
   Design design;
   design.model.lattice.pitch = kBarPitch;
   Material material;
   material.id = material.name = "bar";
   material.youngsModulus = kBarModulus;
   material.density = kBarDensity;
   const auto number = design.model.setMaterial(material);
   for (int x = 0; number && x < length; ++x)
      for (int y = 0; y < width; ++y)
         for (int z = 0; z < width; ++z)
            design.model.root.cells.set({x, y, z}, Cell{*number, 0, 0});
   design.setup.supports.push_back({Box{{0, 0, 0}, {0, width - 1, width - 1}}, kAllFreedoms});
   design.setup.solver = subject.provided->id;
   return design;
}

std::vector<Trial> trialsFor(const Subject &subject, const Abilities &can, Findings &findings)
{
   std::vector<std::pair<std::string, Design>> designs;
   if (can.mechanics() && (can.has(can.lattices, "*") || can.has(can.lattices, LatticeSpec().id))) {
      designs.emplace_back("a bar that bends under its weight", barDesign(subject, 8, 2));
      designs.back().second.setup.gravity = {0, 0, -9.81};
   }
   for (const auto &file : subject.designs) {
      auto opened = openDesign(file, Job());
      if (!opened) {
         findings.fail(opened.error().message);
         continue;
      }
      opened->design.setup.solver = subject.provided->id;
      designs.emplace_back(file.string(), std::move(opened->design));
   }
   if (designs.empty())
      findings.skip("there is no scene that it is known to solve: give a design by --design FILE");
   std::vector<Trial> trials;
   for (const auto &[label, design] : designs)
      for (const Analysis analysis : kAnalyses)
         if (can.can(analysis))
            trials.push_back({fmt::format("{}, {}", label, analysisName(analysis)), design, analysis});
   return trials;
}

Result<Answers> runTrial(const Subject &subject, const Trial &trial, const RunOptions &options)
{
   Job job;
   job.setThreads(options.threads);
   auto scene = trial.scene(subject);
   if (!scene)
      return scene.error();
   auto run = SolverRun::create(options.isolated ? Catalogue::find(subject.folders, false, Isolate::all)
                                                 : subject.catalogue,
                                *std::move(scene), trial.design.setup, options.values, job);
   if (!run)
      return run.error();
   constexpr double kForever = 1e9; // s
   if (trial.analysis == Analysis::dynamics) {
      diatom_step_result result{sizeof(diatom_step_result), DIATOM_RUNNING, 0, 0, 0, -1, -1, 0, 0};
      const diatom_step_request request{sizeof(diatom_step_request), kForever, 0, kSteps, 0};
      if (const Status stepped = (*run)->step(request, result, job); !stepped)
         return stepped.error();
      if (result.state == DIATOM_DIVERGED)
         return Error{ErrorCode::unstable, "it diverged at its own step"};
   } else {
      const diatom_step_request request{sizeof(diatom_step_request), endOfCurves(trial.design.setup), 0,
                                        std::numeric_limits<std::int64_t>::max(), 0};
      double residual = 0;
      std::int64_t iterations = 0;
      if (const Status settled = settle(**run, request, "a balance", residual, iterations, job); !settled)
         return settled.error();
   }
   Answers answers;
   for (const SolverRun::Told &one : (*run)->told()) {
      auto values = (*run)->output(one.name, job);
      if (!values)
         return values.error();
      answers[one.name] = *std::move(values);
   }
   return answers;
}

} // namespace diatom::check
