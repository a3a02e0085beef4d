// Hard cases by implicit steps, which no stiffness limits: each far beyond the explicit limit of its scene.
#include "study/stability_cases.h"
#include "study/stability_scenes.h"

#include <fmt/format.h>

#include <cmath>

namespace diatom::stability {

namespace {

/// What one undamped scene has to keep.
struct Kept
{
   double beyond = 20; // steps over the explicit limit
   bool free = true;
};

Case stepped(const char *id, const char *scene, const std::function<Design()> &design, const Kept &kept)
{
   return {id, scene, [=](const Bench &bench, StabilityRow &row) -> Status {
              const auto limit = begin(bench, design(), {"semi_implicit"});
              if (!limit)
                 return limit.error();
              const Settings settings{"implicit", 0, kept.beyond * (*limit)->stableStep()};
              const auto course = follow(bench, design(), settings, bench.steps(200, 2000), 200);
              if (!course)
                 return course.error();
              tell(*course, settings, row);
              row.how = fmt::format("implicit, {:g} times the explicit limit", kept.beyond);
              const Energy &start = course->start;
              row.checks.push_back({"most energy over that at the start, less 1",
                                    course->mostEnergy / (start.kinetic + start.elastic) - 1, 1e-9,
                                    "what is too fast for the step is damped, and nothing is added"});
              if (kept.free)
                 row.checks.push_back(
                     {"change of linear momentum", course->linear,
                      0x1p-53 * std::sqrt(static_cast<double>(course->steps * course->cells)),
                      "2^-53 a cell and step, as a random walk: both ends of a bond get opposite forces"});
              return {};
           }};
}

/// A step that shows nothing of what goes on, undamped: large turns give it energy, and it has to stop.
Status tooFar(const Bench &bench, StabilityRow &row)
{
   const Design design = shakenHalves(1e6);
   const auto limit = begin(bench, design, {"semi_implicit"});
   if (!limit)
      return limit.error();
   const Settings settings{"implicit", 0, 1000 * (*limit)->stableStep()};
   const auto course = follow(bench, design, settings, 2000, 2000);
   if (!course)
      return course.error();
   tell(*course, settings, row);
   row.how = "implicit, 1000 times the explicit limit";
   row.failure.clear(); // that it stops is what is asked
   const bool stopped = course->stopped.has_value();
   row.checks.push_back({"goes on (1 = yes)", stopped ? 0.0 : 1.0, 0, "it gains energy"});
   row.checks.push_back({"steps from the last good state to the stop", static_cast<double>(course->lost), 100,
                         "as asked of divergence"});
   row.checks.push_back({"energy of the state that is kept, over that at the start",
                         (course->end.kinetic + course->end.elastic) / course->start.kinetic, 5,
                         "a run stops when four times its energy has come from nowhere"});
   const bool named = stopped && course->stopped->message.find("bond between cells") != std::string::npos;
   row.checks.push_back({"names no bond (1 = yes)", named ? 0.0 : 1.0, 0, "the culprit is known"});
   return {};
}

} // namespace

std::vector<Case> implicitCases()
{
   return {stepped("implicit-metals", "free bar, half steel, half aluminium, cells of 1 mm, shaken at 1 m/s",
                   shakenMetals, {}),
           stepped("implicit-stiffness-1e6", "free bar of halves 1 : 1e+06 in stiffness, shaken",
                   [] { return shakenHalves(1e6); }, {}),
           stepped("implicit-spin", "free cube, its rim at 0.02 of the speed of sound",
                   [] { return spinningCube(0.02); }, {}),
           stepped("implicit-released-beam",
                   "beam of 40 cells, held at one end, let go from an arc of 60 degrees", releasedBeam,
                   {.free = false}),
           {"implicit-too-far",
            "the bar of halves at a step that shows nothing of its motion: it has to stop", tooFar}};
}

} // namespace diatom::stability
