// A machine that describes itself falsely.
#pragma once

#include <diatom/machine.hpp>

#include <limits>

namespace false_answers {

class FalseMachine : public diatom::sdk::Machine
{
public:
   FalseMachine(const diatom::sdk::Call &, const diatom_create &create)
       : m_fault(diatom::sdk::Values(create.values).text("fault"))
   {}

   diatom::sdk::MachineDescription describe() const override
   {
      diatom::sdk::MachineDescription machine;
      machine.axes = {{"X", false, {1, 0, 0}, 0, 1, 0, 0.5, 1},
                      {"Y", false, {0, 1, 0}, 0, 1, 0, 0.5, 1},
                      {"Z", false, {0, 0, 1}, 0, 1, 0.5, 0.5, 1}};
      machine.feeders = {{{0.9, 0.9, 0}, 1, 1, 0}};
      machine.clearance = 0.05;
      machine.approach = 0.01;
      machine.feed = 0.1;
      machine.gripSeconds = 0.5;
      machine.suffix = "txt";
      if (m_fault == "limits")
         machine.axes[1].minimum = 2; // above its maximum
      if (m_fault == "not finite")
         machine.axes[0].speed = std::numeric_limits<double>::quiet_NaN();
      return machine;
   }
   void post(const diatom::sdk::Call &, const diatom_program &, diatom::sdk::ProgramText &text) const override
   {
      if (m_fault == "throws")
         throw std::runtime_error("the ribbon is dry");
      text << "moves\n";
   }

private:
   std::string m_fault;
};

} // namespace false_answers
