// Bars turned by 90 to 360 degrees, by a balance and in motion, and balances of badly conditioned scenes.
#include "study/stability_cases.h"

#include "scene/balance.h"
#include "study/beam_theory.h"
#include "study/stability_scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace diatom::stability {

namespace {

constexpr int kBonds = 24;

/// A bar held at its first cell with a moment at its last that turns it by `angle` (rad): each bond takes
/// its share, and each lies along the mean of its two cells' turns.
Design rolled(double angle)
{
   const Material material = rubber();
   Design design = block({kBonds + 1, 1, 1}, material);
   hold(design, layer({kBonds + 1, 1, 1}, 0, 0));
   const double bending = material.youngsModulus * std::pow(kPitch, 3) / 12;
   design.setup.loads = {{Index{kBonds, 0, 0}, {0, 0, 0}, {0, -bending * angle / kBonds, 0}}};
   return design;
}

/// Distance of the tip from where the exact polygon ends, over the bar's length.
template<typename Probe>
Result<double> missOf(double angle, const Probe &probe)
{
   double x = -kBonds, z = 0;
   for (int i = 0; i < kBonds; ++i) {
      x += std::cos((i + 0.5) * angle / kBonds);
      z += std::sin((i + 0.5) * angle / kBonds);
   }
   double at[2];
   for (int k = 0; k < 2; ++k) {
      const Result<double> value = probe(k == 0 ? "x" : "z");
      if (!value)
         return value.error();
      at[k] = *value / kPitch;
   }
   return std::hypot(at[0] - x, at[1] - z) / kBonds;
}

Result<Balance> balanceOf(const Bench &bench, const Design &design)
{
   const auto lattice = Lattice::make(*bench.catalogue, design.model.lattice, bench.job);
   if (!lattice)
      return lattice.error();
   const Hierarchy hierarchy(*lattice, design.model);
   auto scene = Scene::build(hierarchy, design.setup, bench.job, Analysis::statics);
   if (!scene)
      return scene.error();
   return solveStatics(bench.catalogue, *std::move(scene), design.setup, {}, {}, bench.job);
}

Case rolledStill(int degrees)
{
   return {fmt::format("roll-{}-balance", degrees),
           fmt::format("bar of {} bonds turned by {} degrees by a moment, as a balance", kBonds, degrees),
           [degrees](const Bench &bench, StabilityRow &row) -> Status {
              const double angle = degrees * std::numbers::pi / 180;
              const auto balance = balanceOf(bench, rolled(angle));
              if (!balance)
                 return balance.error();
              const SolverRun &run = *balance->run;
              row.how = fmt::format("Newton, {} iterations", balance->iterations);
              row.cells = run.scene().cells();
              const std::int64_t tip = run.scene().cellAt({kBonds, 0, 0});
              const auto miss =
                  missOf(angle, [&](const char *channel) { return run.probe(tip, channel, bench.job); });
              if (!miss)
                 return miss.error();
              row.checks.push_back({"tip from the exact polygon, over the length", *miss, 1e-8,
                                    "the tolerance of the balance"});
              return {};
           }};
}

Case rolledInMotion(int degrees)
{
   return {
       fmt::format("roll-{}-motion", degrees),
       fmt::format("the same bar let go straight, in motion with drag until it rests, {} degrees", degrees),
       [degrees](const Bench &bench, StabilityRow &row) -> Status {
          const double angle = degrees * std::numbers::pi / 180;
          const Material material = rubber();
          const Bar bar = Bar::square((kBonds + 0.5) * kPitch, kPitch, material.youngsModulus,
                                      material.poissonRatio, material.density);
          const double omega = 2 * std::numbers::pi * bendingFrequency(bar);
          Design design = rolled(angle);
          design.setup.drag = 2 * omega;
          const Settings settings{"semi_implicit", 0.9};
          auto started = begin(bench, design, settings);
          if (!started)
             return started.error();
          Simulation &simulation = **started;
          if (Status moved = simulation.advance(25 / omega, bench.job); !moved)
             return moved;
          row.how = settings.text();
          row.cells = simulation.scene().cells();
          row.steps = simulation.steps();
          const std::int64_t tip = simulation.scene().cellAt({kBonds, 0, 0});
          const auto miss =
              missOf(angle, [&](const char *channel) { return simulation.probe(tip, channel, bench.job); });
          if (!miss)
             return miss.error();
          row.checks.push_back({"tip from the exact polygon, over the length", *miss, 1e-6,
                                "what is left of the slowest motion after 25 / omega, (1 + 25) exp(-25)"});
          return {};
       }};
}

Case balanced(const char *id, const char *scene, const std::function<Design(const Bench &)> &design)
{
   return {id, scene, [design](const Bench &bench, StabilityRow &row) -> Status {
              const auto balance = balanceOf(bench, design(bench));
              if (!balance)
                 return balance.error();
              row.how = fmt::format("Newton, {} iterations", balance->iterations);
              row.cells = balance->run->scene().cells();
              row.checks.push_back({"unbalanced force over the largest at work", balance->residual, 1e-8,
                                    "the tolerance asked for"});
              return {};
           }};
}

/// Cells of two materials in a fixed random order.
Design mixed(Index size, double ratio)
{
   Material hard = rubber();
   hard.id = hard.name = "hard";
   hard.youngsModulus *= ratio;
   Design design = block(size, rubber());
   const auto index = design.model.setMaterial(hard);
   std::uint32_t random = 7;
   for (std::int32_t x = 0; x < size.x; ++x)
      for (std::int32_t y = 0; y < size.y; ++y)
         for (std::int32_t z = 0; z < size.z; ++z) {
            random = random * 1664525u + 1013904223u; // Numerical Recipes' generator
            if (random >> 31)
               design.model.root.cells.set({x, y, z}, Cell{index ? *index : MaterialIndex{0}, 0, 0});
         }
   hold(design, layer(size, 2, 0));
   design.setup.gravity = {0, 0, -9.81};
   return design;
}

/// A cantilever's sag against Timoshenko's beam: what the peer's motion does not reach at 20 cells and more.
Case sagging(int cells)
{
   return {
       fmt::format("sag-{}", cells),
       fmt::format("rest of a cantilever of {} cells under a force at its tip", cells),
       [cells](const Bench &bench, StabilityRow &row) -> Status {
          const Material material = rubber();
          Design design = block({cells + 1, 1, 1}, material);
          hold(design, layer({cells + 1, 1, 1}, 0, 0));
          const Bar bar = Bar::square(cells * kPitch, kPitch, material.youngsModulus, material.poissonRatio,
                                      material.density);
          const double length = cells * kPitch,
                       force = 1e-6 * bar.bending / (length * length); // small: the beam's theory is linear
          design.setup.loads = {{Index{cells, 0, 0}, {0, 0, -force}, {}}};
          const auto balance = balanceOf(bench, design);
          if (!balance)
             return balance.error();
          row.how = fmt::format("Newton, {} iterations", balance->iterations);
          row.cells = balance->run->scene().cells();
          const auto sag = balance->run->probe(balance->run->scene().cellAt({cells, 0, 0}), "z", bench.job);
          if (!sag)
             return sag.error();
          const double exact = -force * (std::pow(length, 3) / (3 * bar.bending) + length / bar.shear);
          row.checks.push_back({"error of the sag", std::abs(*sag / exact - 1), 1e-6,
                                "Timoshenko's bond is exact at its nodes; what is left is the tolerance"});
          return {};
       }};
}

} // namespace

std::vector<Case> bendingCases()
{
   std::vector<Case> cases;
   for (const int degrees : {90, 180, 360}) {
      cases.push_back(rolledStill(degrees));
      cases.push_back(rolledInMotion(degrees));
   }
   for (const int cells : {10, 20, 40})
      cases.push_back(sagging(cells));
   cases.push_back(balanced("balance-1e6",
                            "block, half its cells at random 10^6 times stiffer, under gravity",
                            [](const Bench &bench) {
                               const std::int32_t n = bench.edge(6, 14);
                               return mixed({n, n, n}, 1e6);
                            }));
   cases.push_back(
       balanced("balance-28", "block of 28^3 cells (brief: 12^3) under gravity", [](const Bench &bench) {
          const std::int32_t n = bench.edge(12, 28);
          Design design = block({n, n, n}, rubber());
          hold(design, layer({n, n, n}, 2, 0));
          design.setup.gravity = {0, 0, -9.81};
          return design;
       }));
   return cases;
}

} // namespace diatom::stability
