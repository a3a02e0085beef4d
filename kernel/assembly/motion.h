// Where a machine's axes must stand for a point of its tool, and how long its moves take.
#pragma once

#include "core/vec.h"

#include <diatom/abi/machine.h>

#include <array>
#include <string>
#include <vector>

namespace diatom {

/// A machine whose tool is moved by exactly three independent sliding axes; other axes stay at home. Built
/// from a description that checkDescription() has passed; keeps pointers into it.
class Motion
{
public:
   explicit Motion(const diatom_machine_description &machine);

   /// Values of the three sliding axes for a tool position, m.
   Vec3 axesAt(const Vec3 &tool) const { return m_toAxes * tool; }
   Vec3 toolAt(const Vec3 &axes) const { return m_toTool * axes; }
   /// The machine's number of sliding axis k.
   int axis(int k) const { return m_axis[static_cast<std::size_t>(k)]; }
   Vec3 home() const;
   /// Names the first axis that would leave its range, with both; empty when all stay inside.
   std::string outside(const Vec3 &tool) const;

   /// Seconds of a straight move between axis values that starts and ends at rest: trapezoidal, along the
   /// line as fast as the slowest axis allows, never above `speed` m/s of the tool (0 = rapid).
   double seconds(const Vec3 &from, const Vec3 &to, double speed) const;

private:
   const diatom_machine_description &m_machine;
   std::array<int, 3> m_axis{};
   Mat3 m_toTool = Mat3::Identity(), m_toAxes = Mat3::Identity();
};

/// What is wrong with a machine's description, in one sentence; empty when nothing is.
std::string checkDescription(const diatom_machine_description &machine);

} // namespace diatom
