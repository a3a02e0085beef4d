#include "assembly/motion.h"

#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace diatom {

namespace {

std::vector<int> slidingAxes(const diatom_machine_description &machine)
{
   std::vector<int> sliding;
   for (int a = 0; a < machine.axes; ++a)
      if (machine.axis_kind[a] == DIATOM_AXIS_LINEAR)
         sliding.push_back(a);
   return sliding;
}

Mat3 directions(const diatom_machine_description &machine, const std::vector<int> &sliding)
{
   Mat3 result;
   for (int k = 0; k < 3; ++k)
      result.col(k) =
          Eigen::Map<const Vec3>(machine.axis_direction + 3 * sliding[static_cast<std::size_t>(k)]);
   return result;
}

std::string checkAxis(const diatom_machine_description &machine, int a)
{
   if (!machine.axis_name[a] || machine.axis_name[a][0] == '\0')
      return fmt::format("axis {} has no name", a);
   const double low = machine.axis_minimum[a], high = machine.axis_maximum[a], home = machine.axis_home[a];
   if (!std::isfinite(low) || !std::isfinite(high) || !(low <= home && home <= high))
      return fmt::format("axis {} has a range or home that makes no sense", machine.axis_name[a]);
   const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
   if (!positive(machine.axis_speed[a]) || !positive(machine.axis_acceleration[a]))
      return fmt::format("axis {} has no speed or no acceleration", machine.axis_name[a]);
   const Vec3 direction = Eigen::Map<const Vec3>(machine.axis_direction + 3 * a);
   if (!direction.allFinite() ||
       (machine.axis_kind[a] == DIATOM_AXIS_LINEAR && std::abs(direction.norm() - 1) > 1e-9))
      return fmt::format("axis {} has a direction that is not a unit vector", machine.axis_name[a]);
   return {};
}

std::string checkFeeder(const diatom_machine_description &machine, int f)
{
   const bool finite = Eigen::Map<const Vec3>(machine.feeder_position + 3 * f).allFinite() &&
                       std::isfinite(machine.feeder_pitch[f]) && machine.feeder_pitch[f] >= 0;
   if (!finite || machine.feeder_columns[f] < 1 || machine.feeder_rows[f] < 1)
      return fmt::format("feeder {} has a place, size or pitch that makes no sense", f + 1);
   return {};
}

} // namespace

std::string checkDescription(const diatom_machine_description &machine)
{
   constexpr int kMostAxes = 30; // bits of diatom_program::moved
   if (!DIATOM_HAS(diatom_machine_description, &machine, suffix))
      return "the description is too short";
   if (machine.axes < 0 || machine.axes > kMostAxes || machine.feeders < 0)
      return "the description has a count out of range";
   for (int a = 0; a < machine.axes; ++a)
      if (auto fault = checkAxis(machine, a); !fault.empty())
         return fault;
   for (int f = 0; f < machine.feeders; ++f)
      if (auto fault = checkFeeder(machine, f); !fault.empty())
         return fault;
   const std::vector<int> sliding = slidingAxes(machine);
   if (sliding.size() != 3 || std::abs(directions(machine, sliding).determinant()) < 1e-6)
      return "only machines with exactly three independent sliding axes can be planned for";
   const auto notNegative = [](double value) { return std::isfinite(value) && value >= 0; };
   if (!Eigen::Map<const Vec3>(machine.origin).allFinite() || !notNegative(machine.clearance) ||
       !notNegative(machine.approach) || !notNegative(machine.grip_seconds) || !(machine.feed > 0) ||
       !std::isfinite(machine.feed) || !machine.suffix)
      return "its origin, clearance, approach, feed, dwell or suffix makes no sense";
   return {};
}

Motion::Motion(const diatom_machine_description &machine) : m_machine(machine)
{
   const std::vector<int> sliding = slidingAxes(machine);
   std::copy(sliding.begin(), sliding.end(), m_axis.begin());
   m_toTool = directions(machine, sliding);
   m_toAxes = m_toTool.inverse();
}

Vec3 Motion::home() const
{
   return {m_machine.axis_home[axis(0)], m_machine.axis_home[axis(1)], m_machine.axis_home[axis(2)]};
}

std::string Motion::outside(const Vec3 &tool) const
{
   constexpr double kSlack = 1e-9; // m, rounding of sums
   const Vec3 axes = axesAt(tool);
   for (int k = 0; k < 3; ++k) {
      const double low = m_machine.axis_minimum[axis(k)], high = m_machine.axis_maximum[axis(k)];
      if (!(axes[k] >= low - kSlack && axes[k] <= high + kSlack))
         return fmt::format("{} {:.4g} mm, outside its range of {:.4g} to {:.4g} mm",
                            m_machine.axis_name[axis(k)], axes[k] * 1e3, low * 1e3, high * 1e3);
   }
   return {};
}

double Motion::seconds(const Vec3 &from, const Vec3 &to, double speed) const
{
   const Vec3 step = to - from;
   const double length = (m_toTool * step).norm();
   if (length == 0)
      return 0;
   double fastest = speed > 0 ? speed : std::numeric_limits<double>::infinity();
   double acceleration = std::numeric_limits<double>::infinity();
   for (int k = 0; k < 3; ++k)
      if (step[k] != 0) {
         const double share = length / std::abs(step[k]);
         fastest = std::min(fastest, m_machine.axis_speed[axis(k)] * share);
         acceleration = std::min(acceleration, m_machine.axis_acceleration[axis(k)] * share);
      }
   const double ramps = fastest * fastest / acceleration; // length of speeding up and slowing down
   return ramps < length ? length / fastest + fastest / acceleration : 2 * std::sqrt(length / acceleration);
}

} // namespace diatom
