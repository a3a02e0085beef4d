// Rows of cells along x in which every bond has the same rest strain, driven as a user would: cells that
// conduct between actuators, with a source on every other one.
#pragma once

#include "verify/case_scene.h"

namespace diatom {

/// Cells are, in turn, source, actuator, ground, actuator, and so on: every bond has one actuator, whose half
/// it is, and so takes half of that cell's strain. An odd number of cells.
class ActuatedRow
{
public:
   ActuatedRow(CaseScene &scene, const nlohmann::json &constants, double mass = 0);

   /// Rest strain of every bond, or its rest turn (rad); of bending about z. One call for one row.
   void drive(Actuation::Mode mode, double perBond);
   void fill(Index first, int cells);

private:
   CaseScene &m_scene;
   MaterialIndex m_conductor, m_rising, m_falling;
};

} // namespace diatom
