// Damped and driven motion: what should come to rest does, and what is driven gains no energy of its own.
#include "study/stability_cases.h"
#include "study/stability_scenes.h"

#include <fmt/format.h>

#include <cmath>

namespace diatom::stability {

namespace {

StabilityCheck restCheck(const Course &course, double bound)
{
   const double kinetic = course.end.kinetic;
   return {"kinetic energy at the end over the most",
           course.mostKinetic > 0 ? kinetic / course.mostKinetic : 0, bound,
           "all motion has had many times the slowest mode's time to die"};
}

StabilityCheck driftCheck(const Course &course, double bound, const char *why)
{
   return {"energy that came from nowhere, over what was in play", course.drift, bound, why};
}

/// A block of `n`^3 cells on its held lowest layer under gravity, damped: comes to rest.
Case settled(const char *id, const char *scene, double dampingRatio, std::int32_t brief, std::int32_t full,
             std::int64_t steps)
{
   return {id, scene, [=](const Bench &bench, StabilityRow &row) -> Status {
              const std::int32_t n = bench.edge(brief, full);
              Design design = block({n, n, n}, rubber(dampingRatio));
              hold(design, layer({n, n, n}, 2, 0));
              design.setup.gravity = {0, 0, -9.81};
              const Settings settings{"semi_implicit", 0.9};
              const auto course = follow(bench, design, settings, bench.steps(steps, 4 * steps), 200);
              if (!course)
                 return course.error();
              tell(*course, settings, row);
              row.checks.push_back(restCheck(*course, 1e-9));
              row.checks.push_back(driftCheck(*course, 5e-2, "first order in the step"));
              return {};
           }};
}

Case asInTheThesis(const char *id, std::int32_t n)
{
   return {id,
           fmt::format(
               "free block of {}^3 with damping k/1000, which exploded at a step of 10 us (thesis 6.5)", n),
           [n](const Bench &bench, StabilityRow &row) -> Status {
              // k = E l = 80 N/m, m = 3.5 mg; d = k/1000 is 2.4 times critical (amoeba.md 3.4).
              Design design = block({n, n, n}, stuff("thesis", 3500, 8e4, 2.4));
              shake(design, {n, n, n}, 1e-4, 5);
              const auto asked = begin(bench, design, {"semi_implicit", 0, 1e-5});
              const bool refused = !asked && asked.error().code != ErrorCode::cancelled;
              bool said = refused && asked.error().message.find("stable") != std::string::npos;
              if (asked) { // told when it is asked to step
                 const Status stepped = (*asked)->advance(1e-4, bench.job);
                 said = !stepped && stepped.error().message.find("stable limit") != std::string::npos;
              }
              row.checks.push_back({"10 us is taken without a word (1 = yes)", said ? 0.0 : 1.0, 0,
                                    "beyond the limit: refused, with the bond that sets it"});
              const Settings settings{"semi_implicit", 0.9};
              const auto course = follow(bench, design, settings, bench.steps(4000, 100'000), 200);
              if (!course)
                 return course.error();
              tell(*course, settings, row);
              row.checks.push_back({"most energy over that at the start",
                                    course->mostEnergy / course->start.kinetic, 1 + 1e-9,
                                    "damping takes energy and gives none"});
              return {};
           }};
}

} // namespace

std::vector<Case> settlingCases()
{
   std::vector<Case> cases;
   cases.push_back(settled("settles", "held block under gravity, damping ratio 1, at the solver's own step",
                           1, 8, 20, 6000));
   cases.push_back(settled("heavy-damping", "held block under gravity, damping ratio 5", 5, 6, 12, 20'000));
   cases.push_back(asInTheThesis("thesis-explosion-3", 3));
   cases.push_back(asInTheThesis("thesis-explosion-4", 4));
   cases.push_back(
       {"square-wave", "row of actuators between walls, switched by a square wave",
        [](const Bench &bench, StabilityRow &row) -> Status {
           const Design design = drivenRow(8, Waveform::square, 200, 0.05, stuff("muscle", 1200, 2e6, 0.05));
           const Settings settings{"semi_implicit", 0.5};
           const auto course = follow(bench, design, settings, bench.steps(20'000, 200'000), 400);
           if (!course)
              return course.error();
           tell(*course, settings, row);
           row.checks.push_back({"energy unaccounted for, over all that went through", course->unaccounted,
                                 5e-2, "second order in the step: every switch shakes the fastest modes"});
           return {};
        }});
   cases.push_back({"hard-stops", "actuators of aluminium that push 1 % against held ends of aluminium",
                    [](const Bench &bench, StabilityRow &row) -> Status {
                       Material muscle = aluminium();
                       muscle.id = muscle.name = "muscle";
                       muscle.dampingRatio = 0.02;
                       const Design design = drivenRow(8, Waveform::sine, 2000, 0.01, muscle);
                       const Settings settings{"semi_implicit", 0.9};
                       const auto course = follow(bench, design, settings, bench.steps(20'000, 200'000), 400);
                       if (!course)
                          return course.error();
                       tell(*course, settings, row);
                       row.checks.push_back(driftCheck(*course, 5e-2, "first order in the step"));
                       return {};
                    }});
   cases.push_back({"drop", "cube dropped from 5 mm on its edge layer, on hard damped ground with friction",
                    [](const Bench &bench, StabilityRow &row) -> Status {
                       Design design = block({3, 3, 3}, rubber(0.1));
                       design.setup.gravity = {0, 0, -9.81};
                       design.setup.ground.present = true;
                       design.setup.ground.height = -5.5e-3;
                       Start tilt;
                       tilt.where = Box{{0, 0, 0}, {2, 2, 2}};
                       tilt.turn = {0.4, 0.2, 0};
                       tilt.about = std::array<double, 3>{kPitch, kPitch, kPitch};
                       design.setup.starts = {tilt};
                       const Settings settings{"semi_implicit", 0.9};
                       const auto course = follow(bench, design, settings, bench.steps(60'000, 300'000), 600);
                       if (!course)
                          return course.error();
                       tell(*course, settings, row);
                       row.checks.push_back(restCheck(*course, 1e-6));
                       row.checks.push_back(driftCheck(*course, 5e-2, "first order in the step"));
                       return {};
                    }});
   return cases;
}

} // namespace diatom::stability
