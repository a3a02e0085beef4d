// Motion without damping: whatever the contrast or the speed, energy and momentum stay.
#include "study/stability_cases.h"
#include "study/stability_scenes.h"

#include <fmt/format.h>

#include <cmath>

namespace diatom::stability {

namespace {

constexpr double kSmall = 1e-4; // of the speed of sound: also the strains, roughly

/// A linear oscillator stepped by semi-implicit Euler or Verlet at the fraction a of its limit keeps
/// v^2 + w^2 x^2 - 2 a w x v to rounding, so that its energy swings by at most this factor (c07-conservation
/// of the validation cases).
double swing(double ofLimit) { return (1 + ofLimit) / (1 - ofLimit); }

/// The energy of a scene is a sum over modes, of which only the fastest come near that factor.
void checkEnergy(const Course &course, const Settings &settings, double secular, StabilityRow &row)
{
   const double ofLimit = settings.ofLimit;
   const char *why = "as asked of long runs; at larger steps the swing of fast modes is part of the mean";
   if (settings.precision == "f32") {
      // Displacements are rounded by 2^-24 of how far a body has gone, against a swing of v / w of the
      // fastest mode, once a step; the squares add up. Of them a rounding makes 1/12 and a steady way 1/3;
      // fourfold for what this leaves out.
      const double speed = std::sqrt(2 * course.start.kinetic / course.mass);
      const double swing = speed * course.step / (2 * ofLimit);
      const double noise = 0x1p-24 * course.travel / swing;
      secular += static_cast<double>(course.steps) * noise * noise / 9;
      why = "displacements are rounded by 2^-24 of how far the body has gone: noise that heats its modes";
   }
   row.checks.push_back({"most energy over its mean in the first tenth",
                         course.mostEnergy / course.firstTenth, swing(ofLimit),
                         "a mode at this fraction of its limit swings so far"});
   row.checks.push_back({"mean energy, last tenth against first",
                         std::abs(course.lastTenth / course.firstTenth - 1), secular, why});
}

void checkMomentum(const Course &course, bool single, StabilityRow &row)
{
   // Rounding of each cell in each step, adding up as a random walk.
   const double rounding =
       (single ? 0x1p-24 : 0x1p-53) * std::sqrt(static_cast<double>(course.steps * course.cells));
   const char *why =
       single ? "2^-24 a cell and step, as a random walk" : "2^-53 a cell and step, as a random walk";
   row.checks.push_back({"change of linear momentum", course.linear, rounding, why});
   row.checks.push_back({"change of angular momentum", course.angular, rounding, why});
}

struct Undamped
{
   Settings settings;
   std::int64_t brief = 4000, full = 100'000;
   double secular = 1e-2;
   bool dense = false;
   bool free = true;
};

Case undamped(const char *id, const std::string &scene, const std::function<Design(const Bench &)> &design,
              const Undamped &how)
{
   return {id, scene, [design, how](const Bench &bench, StabilityRow &row) -> Status {
              const auto course = follow(bench, design(bench), how.settings, bench.steps(how.brief, how.full),
                                         400, how.dense);
              if (!course)
                 return course.error();
              tell(*course, how.settings, row);
              checkEnergy(*course, how.settings, how.secular, row);
              if (how.free)
                 checkMomentum(*course, how.settings.precision == "f32", row);
              return {};
           }};
}

Design heavy(double ratio)
{
   const Index size{12, 2, 2};
   Material light = rubber(), heavy = rubber();
   heavy.id = heavy.name = "heavy";
   heavy.density *= ratio;
   Design design = halves(size, light, heavy);
   // Each half at a hundredth of its own speed of sound: strains of a few per cent in both.
   shake(design, size, 1e-2 * soundSpeed(light), 2);
   for (Start &start : design.setup.starts)
      if (std::get<Index>(start.where).x >= size.x / 2)
         for (double &speed : start.velocity)
            speed /= std::sqrt(ratio);
   return design;
}

} // namespace

std::vector<Case> undampedCases()
{
   std::vector<Case> cases;
   for (const double ratio : {1.0, 1e3, 1e6})
      cases.push_back(undamped(ratio == 1     ? "stiffness-1"
                               : ratio == 1e3 ? "stiffness-1e3"
                                              : "stiffness-1e6",
                               fmt::format("free bar of halves 1 : {:g} in stiffness, shaken", ratio),
                               [ratio](const Bench &) { return shakenHalves(ratio); }, {}));
   cases.push_back(undamped("mass-1e6", "free bar of halves 1 : 10^6 in mass, shaken",
                            [](const Bench &) { return heavy(1e6); }, {}));
   const auto metals = [](const Bench &) { return shakenMetals(); };
   cases.push_back(undamped("metals", "free bar, half steel, half aluminium, cells of 1 mm, shaken at 1 m/s",
                            metals, {}));
   Undamped inSingle;
   inSingle.settings.precision = "f32";
   cases.push_back(undamped("single-metals", "the same bar of metals in single precision", metals, inSingle));
   cases.push_back(undamped(
       "single-stiffness-1e3", "free bar of halves 1 : 1000 in stiffness, shaken, in single precision",
       [](const Bench &) { return shakenHalves(1e3); }, inSingle));
   const auto shaken = [](const Bench &) {
      // Small, so that modes stay modes: what they exchange at large turns is physics, not drift.
      Design design = block({6, 2, 2}, rubber());
      shake(design, {6, 2, 2}, kSmall * soundSpeed(rubber()), 4);
      return design;
   };
   for (const char *integrator : {"semi_implicit", "verlet"}) {
      Undamped how{{integrator, 0.5}, 100'000, 1'000'000, 1e-4, true, true};
      cases.push_back(undamped(*integrator == 's' ? "long-semi-implicit" : "long-verlet",
                               "free bar, shaken, many steps", shaken, how));
   }
   Undamped single{{"semi_implicit", 0.5, 0, false, "f32"}, 100'000, 1'000'000, 1e-2, true, true};
   cases.push_back(
       undamped("single-long", "free bar, shaken, many steps in single precision", shaken, single));
   cases.push_back(undamped("kick", "held block, its free half kicked across at 0.05 of the speed of sound",
                            [](const Bench &) {
                               Design design = block({8, 4, 4}, rubber());
                               hold(design, layer({8, 4, 4}, 0, 0));
                               kick(design, {8, 4, 4}, 0.05 * soundSpeed(rubber()));
                               return design;
                            },
                            {{"semi_implicit", 0.9}, 4000, 100'000, 5e-2, false, false}));
   const auto spinning = [](const Bench &) { return spinningCube(0.2); };
   cases.push_back(undamped("spin", "free cube, its rim at 0.2 of the speed of sound", spinning,
                            {{"semi_implicit", 0.9}, 4000, 100'000, 1e-2, false, true}));
   cases.push_back(undamped("single-spin", "the same cube in single precision", spinning,
                            {{"semi_implicit", 0.9, 0, false, "f32"}, 4000, 100'000, 1e-2, false, true}));
   cases.push_back(undamped("released-beam",
                            "beam of 40 cells, held at one end, let go from an arc of 60 degrees",
                            [](const Bench &) { return releasedBeam(); },
                            {{"semi_implicit", 0.9}, 4000, 100'000, 5e-2, false, false}));
   cases.push_back(undamped("folded", "free bar of 24 cells, let go from an arc of 270 degrees",
                            [](const Bench &) {
                               Design design = block({24, 1, 1}, rubber());
                               bendToArc(design, 24, 4.71238898038469);
                               return design;
                            },
                            {{"semi_implicit", 0.5}, 4000, 100'000, 5e-2, false, true}));
   cases.push_back(undamped("dense-block",
                            "held block of 28^3 cells (brief: 10^3), its free half kicked across",
                            [](const Bench &bench) {
                               const std::int32_t n = bench.edge(10, 28);
                               Design design = block({n, n, n}, rubber());
                               hold(design, layer({n, n, n}, 0, 0));
                               kick(design, {n, n, n}, 0.01 * soundSpeed(rubber()));
                               return design;
                            },
                            {{"semi_implicit", 0.9}, 1000, 20'000, 5e-2, false, false}));
   cases.push_back(
       {"runge-kutta", "free bar, shaken: the fourth order may lose energy, never gain any",
        [shaken](const Bench &bench, StabilityRow &row) -> Status {
           const Settings settings{"rk4", 0.5};
           const auto course = follow(bench, shaken(bench), settings, bench.steps(4000, 100'000), 400);
           if (!course)
              return course.error();
           tell(*course, settings, row);
           row.checks.push_back({"most energy over that at the start, less 1",
                                 course->mostEnergy / (course->start.kinetic) - 1, 1e-9,
                                 "damps every mode below its limit"});
           row.checks.push_back({"change of linear momentum", course->linear, 1e-12,
                                 "rounding: every stage's forces balance"});
           row.checks.push_back({"change of angular momentum", course->angular, kSmall,
                                 "products of places and speeds are not kept by this method: below "
                                 "the strains at work"});
           return {};
        }});
   return cases;
}

} // namespace diatom::stability
