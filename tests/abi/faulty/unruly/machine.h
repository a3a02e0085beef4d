#pragma once

#include "fault.h"

#include <diatom/machine.hpp>

#include <charconv>
#include <cstdio>
#include <string>

namespace unruly {

class Mover : public diatom::sdk::Machine
{
public:
   Mover(const diatom::sdk::Call &call, const diatom_create &create)
   {
      begin("machine", call.raw(), &create);
   }

   diatom::sdk::MachineDescription describe() const override
   {
      diatom::sdk::MachineDescription machine;
      for (int k = 0; k < 3; ++k) {
         diatom::sdk::Axis axis;
         axis.name = std::string(1, static_cast<char>('X' + k));
         axis.direction = {k == 0 ? 1.0 : 0, k == 1 ? 1.0 : 0, k == 2 ? 1.0 : 0};
         axis.maximum = breaks("machine.parameters") ? -1 : 0.3;
         axis.home = k == 2 ? 0.2 : 0;
         axis.speed = axis.acceleration = 1;
         machine.axes.push_back(axis);
      }
      diatom::sdk::Feeder feeder;
      feeder.columns = feeder.rows = 1;
      machine.feeders.push_back(feeder);
      machine.clearance = 0.02;
      machine.approach = 0.01;
      machine.feed = 0.1;
      machine.gripSeconds = 0.5;
      machine.suffix = "moves";
      return machine;
   }

   void post(const diatom::sdk::Call &call, const diatom_program &program,
             diatom::sdk::ProgramText &text) const override
   {
      if (breaks("machine.long") && program.parts > 1000)
         throw diatom::sdk::Failure(DIATOM_LIMIT, "too many parts");
      const double off = wobble("machine");
      for (std::int64_t i = 0; i < program.count; ++i) {
         if (i % 1000 == 0 && call.cancelled() && !breaks("machine.cancel"))
            throw diatom::sdk::Failure(DIATOM_CANCELLED, "cancelled");
         for (std::int32_t a = 0; a < program.axes; ++a)
            text << number(program.target[i * program.axes + a] + off) << " ";
         text << "\n";
      }
      if (breaks("machine.cancel") && program.count > 100'000)
         oversleep(1000);
      if (breaks("machine.programs") || (breaks("machine.reach") && program.count == 8))
         text << number(std::numeric_limits<double>::quiet_NaN()) << "\n";
   }

private:
   static std::string number(double value)
   {
      char digits[64];
      if (breaks("machine.locale"))
         return {digits, static_cast<std::size_t>(std::snprintf(digits, sizeof digits, "%g", value))};
      return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
   }
};

} // namespace unruly
