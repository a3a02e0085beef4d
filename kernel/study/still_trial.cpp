#include "study/still_trial.h"

#include "scene/balance.h"
#include "scene/modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace diatom {

namespace {

/// Position in a mode's six numbers of a displacement's or a turn's channel, -1 for others.
int freedomOf(const std::string &channel)
{
   const auto found = std::find(kFreedoms.begin(), kFreedoms.end(), channel);
   return found == kFreedoms.end() ? -1 : static_cast<int>(found - kFreedoms.begin());
}

/// Part of the largest motion in a mode that the quantity's must reach: modes across it have none at all.
constexpr double kTakesPart = 1e-3;

Result<double> frequencyOf(const Modes &modes, const std::vector<std::int64_t> &cells, int freedom,
                           const Job &job)
{
   for (std::size_t k = 0; k < modes.modes.size(); ++k) {
      if (modes.modes[k].kind != Mode::Kind::vibration)
         continue;
      const auto shape = modes.shape(k, job);
      if (!shape)
         return shape.error();
      const std::size_t first = freedom < 3 ? 0 : 3; // displacements are held against displacements
      double most = 0, own = 0;
      for (std::size_t i = 0; i + 5 < shape->size(); i += 6)
         for (std::size_t j = first; j < first + 3; ++j)
            most = std::max(most, std::abs((*shape)[i + j]));
      for (const std::int64_t cell : cells)
         own = std::max(own, std::abs((*shape)[static_cast<std::size_t>(6 * cell + freedom)]));
      if (own > kTakesPart * most)
         return modes.modes[k].hertz;
   }
   return Error{ErrorCode::invalid, "none of the modes sought moves the quantity's cell in its direction"};
}

Result<double> meanProbe(const SolverRun &run, const std::vector<std::int64_t> &cells,
                         const std::string &channel, const Job &job)
{
   double sum = 0;
   for (const std::int64_t cell : cells) {
      auto value = run.probe(cell, channel, job);
      if (!value)
         return value;
      sum += *value;
   }
   return sum / static_cast<double>(cells.size());
}

} // namespace

bool isStill(const Quantity &quantity)
{
   return quantity.when == Quantity::When::atRest || quantity.when == Quantity::When::frequency;
}

Analysis stillAnalysis(const Quantity &quantity)
{
   return quantity.when == Quantity::When::frequency ? Analysis::modes : Analysis::statics;
}

Result<StillTrial> runStill(const Subject &subject, const Values &values, const Quantity &quantity,
                            const Job &job)
{
   const auto start = std::chrono::steady_clock::now();
   const Analysis analysis = stillAnalysis(quantity);
   const int freedom = freedomOf(quantity.channel);
   if (analysis == Analysis::modes && freedom < 0)
      return Error{ErrorCode::usage, fmt::format("modes have no channel {}", quantity.channel)};
   auto scene = Scene::build(*subject.hierarchy, subject.setup, job, analysis);
   if (!scene)
      return scene.error();
   const auto cells = quantityCells(subject, quantity, **scene);
   if (!cells)
      return cells.error();
   StillTrial trial;
   trial.cells = (*scene)->cells();
   Result<double> value = 0.0;
   if (analysis == Analysis::modes) {
      const auto modes =
          findModes(subject.catalogue, *std::move(scene), subject.setup, values, BalanceRequest{}, job);
      if (!modes)
         return modes.error();
      trial.iterations = modes->iterations;
      value = frequencyOf(*modes, *cells, freedom, job);
   } else {
      const auto balance =
          solveStatics(subject.catalogue, *std::move(scene), subject.setup, values, BalanceRequest{}, job);
      if (!balance)
         return balance.error();
      trial.iterations = balance->iterations;
      value = meanProbe(*balance->run, *cells, quantity.channel, job);
   }
   if (!value)
      return value.error();
   trial.value = *value;
   trial.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
   return trial;
}

Result<Subject> withCellModel(const Subject &subject, CellModel model, const Job &job)
{
   Model changed = subject.hierarchy->model();
   const auto lattice = Lattice::make(*subject.catalogue, changed.lattice, job);
   if (!lattice)
      return lattice.error();
   auto materials = std::make_shared<std::vector<Material>>(*changed.materials);
   for (Material &material : *materials)
      material.cellModel = model;
   changed.materials = materials;
   Subject other = subject;
   other.hierarchy = std::make_shared<const Hierarchy>(*lattice, std::move(changed));
   return other;
}

const char *cellModelName(CellModel model)
{
   constexpr std::array<const char *, 3> kNames{"bond", "block", "solid"};
   return kNames[static_cast<std::size_t>(model)];
}

} // namespace diatom
