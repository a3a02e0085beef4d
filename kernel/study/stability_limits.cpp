// Steps at, below and beyond the stable limit: what is refused, what holds, and how a forced run stops.
#include "study/stability_cases.h"
#include "study/stability_scenes.h"

#include <cmath>
#include <limits>

namespace diatom::stability {

namespace {

/// A soft free bar with one pair of stiff cells, whose bond sets the limit.
Design withOnePair()
{
   const Index size{16, 1, 1};
   Design design = block(size, rubber());
   Material hard = rubber();
   hard.id = hard.name = "hard";
   hard.youngsModulus *= 100;
   const auto index = design.model.setMaterial(hard);
   design.model.root.cells.fill({{9, 0, 0}, {10, 0, 0}}, Cell{index ? *index : MaterialIndex{0}, 0, 0});
   shake(design, size, 1e-3 * soundSpeed(rubber()), 6);
   return design;
}

constexpr const char *kPair[] = {"(9, 0, 0)", "(10, 0, 0)"};

bool namesPair(const std::string &message)
{
   return message.find(kPair[0]) != std::string::npos && message.find(kPair[1]) != std::string::npos;
}

/// The fastest mode, at 0.995 of its bound, swings by 18 at 0.9 of the limit and by 400 at the limit, but has
/// a part of the energy only.
Case withinLimit(const char *id, double ofLimit, double bound, const char *why)
{
   return {id, "free bar with one stiff pair, shaken, at this fraction of the limit",
           [=](const Bench &bench, StabilityRow &row) -> Status {
              const Settings settings{"semi_implicit", ofLimit};
              const auto course = follow(bench, withOnePair(), settings, bench.steps(20'000, 1'000'000), 400);
              if (!course)
                 return course.error();
              tell(*course, settings, row);
              row.checks.push_back({"most energy over that at the start",
                                    course->mostEnergy / course->start.kinetic, bound, why});
              return {};
           }};
}

Case beyondLimit(const char *id, double ofLimit)
{
   return {id, "the same bar, forced beyond the limit: it has to diverge, and to stop",
           [ofLimit](const Bench &bench, StabilityRow &row) -> Status {
              const Design design = withOnePair();
              const auto asked = begin(bench, design, {"semi_implicit", ofLimit});
              if (!asked)
                 return asked.error();
              const Status refused = (*asked)->advance(100 * (*asked)->step(), bench.job);
              row.checks.push_back({"taken without being forced (1 = yes)",
                                    !refused && namesPair(refused.error().message) ? 0.0 : 1.0, 0,
                                    "beyond the limit: refused, with the bond that sets it"});
              const Settings settings{"semi_implicit", ofLimit, 0, true};
              const auto course = follow(bench, design, settings, 20'000, 100);
              if (!course)
                 return course.error();
              tell(*course, settings, row);
              row.failure.clear(); // that it stops is what is asked
              const bool stopped = course->stopped.has_value();
              row.checks.push_back({"goes on (1 = yes)", stopped ? 0.0 : 1.0, 0, "it cannot be stable"});
              row.checks.push_back({"steps from the last good state to the stop",
                                    static_cast<double>(course->lost), 100, "as asked of divergence"});
              row.checks.push_back({"energy of the state that is kept, over that at the start",
                                    (course->end.kinetic + course->end.elastic) / course->start.kinetic, 100,
                                    "a state that can be read and gone on from"});
              row.checks.push_back({"names another place than the stiff pair (1 = yes)",
                                    stopped && namesPair(course->stopped->message) ? 0.0 : 1.0, 0,
                                    "the culprit is known"});
              return {};
           }};
}

} // namespace

std::vector<Case> limitCases()
{
   return {withinLimit("limit-0.9", 0.9, 12, "less than the swing of the fastest mode alone, 18"),
           withinLimit("limit-1.0", 1, 39, "less than the watch for divergence lets pass, 40"),
           beyondLimit("limit-1.1", 1.1), beyondLimit("limit-3", 3)};
}

} // namespace diatom::stability
