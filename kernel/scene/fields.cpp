#include "scene/fields.h"

#include "scene/effects.h"
#include "scene/scene.h"
#include "scene/where.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace diatom {

namespace {

constexpr std::size_t kMostValues = 64;

/// Channels that the set-up's own entries make, see abi/solver.h.
constexpr std::array<std::string_view, 11> kOwnChannels{"fixed",    "driven", "curve",   "force",
                                                        "velocity", "pose",   "gravity", "drag",
                                                        "ground",   "source", "actuator"};

bool isTaken(const std::string &name)
{
   const auto effects = effectNames();
   return std::find(kOwnChannels.begin(), kOwnChannels.end(), name) != kOwnChannels.end() ||
          std::find(effects.begin(), effects.end(), name) != effects.end();
}

} // namespace

std::vector<std::string> fieldNames(const Setup &setup)
{
   std::set<std::string> names;
   for (const Field &field : setup.fields)
      names.insert(field.name);
   return {names.begin(), names.end()};
}

std::string fieldFault(const Field &field)
{
   if (field.name.empty())
      return "has no name";
   if (isTaken(field.name))
      return fmt::format("is called {}, which Diatom means something else by; choose another name",
                         field.name);
   if (field.values.empty() || field.values.size() > kMostValues)
      return fmt::format("must have 1 to {} values", kMostValues);
   if (!std::all_of(field.values.begin(), field.values.end(), [](double v) { return std::isfinite(v); }))
      return "has a value that is not a number";
   return {};
}

void findBadFields(std::vector<Problem> &problems, const Setup &setup)
{
   const auto report = [&](const Field &field, const std::string &fault) {
      problems.push_back({Problem::Severity::error,
                          "bad-field",
                          fmt::format("the field {} on {} {}", field.name, whereText(field.where), fault),
                          {}});
   };
   std::map<std::string, std::size_t> values;
   for (const Field &field : setup.fields) {
      if (const std::string fault = fieldFault(field); !fault.empty())
         report(field, fault);
      const auto [first, added] = values.try_emplace(field.name, field.values.size());
      if (!added && first->second != field.values.size())
         report(field, fmt::format("has {} values where another has {}; give all of them as many",
                                   field.values.size(), first->second));
   }
}

ChannelRows fieldChannel(const Scene &scene, const Setup &setup, std::string_view name)
{
   ChannelRows rows{std::string(name), 1, {}, {}};
   for (const Field &field : setup.fields) {
      if (field.name != name)
         continue;
      rows.stride = static_cast<std::int64_t>(field.values.size());
      for (const std::int64_t cell : scene.cellsIn(field.where)) {
         rows.where.push_back(cell);
         rows.values.insert(rows.values.end(), field.values.begin(), field.values.end());
      }
   }
   return rows;
}

} // namespace diatom
