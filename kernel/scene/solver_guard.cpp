#include "scene/solver_guard.h"

#include "scene/where.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace diatom {

namespace {

/// Outputs that have a row for each cell (the contract's list in abi/solver.h), and how many numbers each.
struct CellOutput
{
   std::string_view name;
   std::int64_t stride;
};
constexpr std::array<CellOutput, 7> kCellOutputs{{{"position", 3},
                                                  {"rotation", 4},
                                                  {"velocity", 3},
                                                  {"angular_velocity", 3},
                                                  {"internal_force", 6},
                                                  {"reaction", 6},
                                                  {"strain", 1}}};

std::string faultOfOutput(const diatom_output &output, const Scene &scene)
{
   constexpr std::int64_t kMost = std::int64_t{1} << 40; // numbers: more than any memory holds
   if (!output.name || !*output.name)
      return "has no name";
   if (output.count < 0 || output.stride < 1 || output.stride > kMost || output.count > kMost / output.stride)
      return fmt::format("has {} rows of {} numbers", output.count, output.stride);
   const auto known = std::find_if(kCellOutputs.begin(), kCellOutputs.end(),
                                   [&](const CellOutput &one) { return one.name == output.name; });
   if (known == kCellOutputs.end())
      return {};
   if (output.count != scene.cells() || output.stride != known->stride)
      return fmt::format("has {} rows of {} numbers where the scene has {} cells and each needs {}",
                         output.count, output.stride, scene.cells(), known->stride);
   return {};
}

} // namespace

std::string faultOfOutputs(const diatom_outputs &outputs, const Scene &scene)
{
   constexpr std::int64_t kMost = 10'000;
   if (outputs.count < 0 || outputs.count > kMost || (outputs.count > 0 && !outputs.output))
      return fmt::format("its list of outputs is broken: it says that it has {}", outputs.count);
   for (std::int64_t k = 0; k < outputs.count; ++k)
      if (const std::string fault = faultOfOutput(outputs.output[k], scene); !fault.empty()) {
         const char *name = outputs.output[k].name;
         return fmt::format("its output '{}' {}", name ? name : std::to_string(k), fault);
      }
   return {};
}

std::string faultOfRows(std::span<const double> values, const std::string &output, std::int64_t first,
                        std::int64_t stride, std::int64_t rows, const Scene &scene)
{
   const auto bad = std::find_if_not(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
   if (bad == values.end())
      return {};
   const std::int64_t row = first + (bad - values.begin()) / stride;
   const std::string place = rows == scene.cells()
                                 ? "cell " + indexText(scene.indices()[static_cast<std::size_t>(row)])
                                 : "row " + std::to_string(row);
   return fmt::format("its output '{}' is not a number at {}", output, place);
}

std::string faultOfStep(const diatom_step_result &result)
{
   if (result.state < DIATOM_RUNNING || result.state > DIATOM_DIVERGED)
      return fmt::format("its step ended in a state {} that does not exist", result.state);
   if (!std::isfinite(result.time) || result.steps < 0 || result.iterations < 0)
      return "its step ended at a time or count that is not one";
   return {};
}

} // namespace diatom
