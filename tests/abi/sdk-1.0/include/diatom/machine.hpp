// Machines in C++: describe axes and feeders, write programs. A plugin derives from Machine, says
// DIATOM_MACHINE(Class) and is done; the class is made anew for each set of parameter values and is used from
// any thread.
#pragma once

#include <diatom/abi/machine.h>
#include <diatom/plugin.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace diatom::sdk {
inline namespace v1 {

/// Exactly `decimals` digits after the point whatever the locale; never "-0.000".
inline std::string fixedText(double value, int decimals)
{
   char text[400]; // the largest double has 309 digits
   const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr;
   const std::string_view digits(text, static_cast<std::size_t>(end - text));
   const bool zero = digits.find_first_not_of("-0.") == std::string_view::npos;
   return std::string(zero && digits.front() == '-' ? digits.substr(1) : digits);
}

/// At most `decimals` digits after the point, none that say nothing, no exponent.
inline std::string plainText(double value, int decimals)
{
   std::string text = fixedText(value, decimals);
   if (text.find('.') != std::string::npos) {
      text.erase(text.find_last_not_of('0') + 1);
      if (text.back() == '.')
         text.pop_back();
   }
   return text;
}

/// SI: metres, radians, seconds.
struct Axis
{
   std::string name;
   bool rotary = false;
   std::array<double, 3> direction{};
   double minimum = 0, maximum = 0, home = 0;
   double speed = 0, acceleration = 0;
};

struct Feeder
{
   std::array<double, 3> position{}; // of its first part
   int columns = 1, rows = 1;
   double pitch = 0;
};

/// abi/machine.h says what each field means.
struct MachineDescription
{
   std::vector<Axis> axes;
   std::vector<Feeder> feeders;
   std::array<double, 3> origin{};
   double clearance = 0, approach = 0, feed = 0, gripSeconds = 0;
   std::string suffix;
};

/// Collects text and hands it over in pieces.
class ProgramText
{
public:
   explicit ProgramText(const diatom_text_sink *sink) : m_sink(sink) {}

   ProgramText &operator<<(std::string_view text)
   {
      m_buffer += text;
      if (m_buffer.size() > kPiece)
         flush();
      return *this;
   }
   /// Call it at the end. Throws when the host takes no more.
   void flush()
   {
      const auto count = static_cast<std::int64_t>(m_buffer.size());
      if (count > 0 && m_sink->text(m_sink, m_buffer.data(), count) != DIATOM_OK)
         throw Failure(DIATOM_CANCELLED, "the host takes no more text");
      m_buffer.clear();
   }

private:
   static constexpr std::size_t kPiece = 1 << 16;
   const diatom_text_sink *m_sink;
   std::string m_buffer;
};

class Machine
{
public:
   virtual ~Machine() = default;
   virtual MachineDescription describe() const = 0;
   /// Text of the program, or of one piece of it (program.piece). Same program, same text.
   virtual void post(const Call &call, const diatom_program &program, ProgramText &text) const = 0;
};

namespace detail {

/// A machine with its description laid out as the C table wants it.
struct MachineSelf
{
   std::unique_ptr<Machine> machine;
   MachineDescription source;
   std::vector<const char *> names;
   std::vector<std::int32_t> kinds, columns, rows;
   std::vector<double> directions, minima, maxima, homes, speeds, accelerations, positions, pitches;
   diatom_machine_description table{};

   explicit MachineSelf(std::unique_ptr<Machine> made) : machine(std::move(made)), source(machine->describe())
   {
      for (const Axis &axis : source.axes) {
         names.push_back(axis.name.c_str());
         kinds.push_back(axis.rotary ? DIATOM_AXIS_ROTARY : DIATOM_AXIS_LINEAR);
         directions.insert(directions.end(), axis.direction.begin(), axis.direction.end());
         minima.push_back(axis.minimum);
         maxima.push_back(axis.maximum);
         homes.push_back(axis.home);
         speeds.push_back(axis.speed);
         accelerations.push_back(axis.acceleration);
      }
      for (const Feeder &feeder : source.feeders) {
         positions.insert(positions.end(), feeder.position.begin(), feeder.position.end());
         columns.push_back(feeder.columns);
         rows.push_back(feeder.rows);
         pitches.push_back(feeder.pitch);
      }
      table = {sizeof table,
               static_cast<std::int32_t>(source.axes.size()),
               static_cast<std::int32_t>(source.feeders.size()),
               names.data(),
               kinds.data(),
               directions.data(),
               minima.data(),
               maxima.data(),
               homes.data(),
               speeds.data(),
               accelerations.data(),
               positions.data(),
               columns.data(),
               rows.data(),
               pitches.data(),
               {source.origin[0], source.origin[1], source.origin[2]},
               source.clearance,
               source.approach,
               source.feed,
               source.gripSeconds,
               source.suffix.c_str()};
   }
   MachineSelf(const MachineSelf &) = delete;
   MachineSelf &operator=(const MachineSelf &) = delete;
};

/// The C table of a class derived from Machine that is made from (const Call &, const diatom_create &).
template<typename Class>
struct MachineTable
{
   static std::int32_t create(const diatom_call *call, const diatom_create *create, void **self) noexcept
   {
      return guarded(call, [&] {
         *self = std::make_unique<MachineSelf>(std::make_unique<Class>(Call(call), *create)).release();
      });
   }
   static std::int32_t describe(void *self, const diatom_call *call,
                                const diatom_machine_description **machine) noexcept
   {
      return guarded(call, [&] { *machine = &static_cast<MachineSelf *>(self)->table; });
   }
   static std::int32_t post(void *self, const diatom_call *call, const diatom_program *program,
                            const diatom_text_sink *sink) noexcept
   {
      return guarded(call, [&] {
         ProgramText text(sink);
         static_cast<MachineSelf *>(self)->machine->post(Call(call), *program, text);
         text.flush();
      });
   }
   static void destroy(void *self) noexcept { delete static_cast<MachineSelf *>(self); }

   static const void *get(const char *interface) noexcept
   {
      static constexpr diatom_machine table{create, describe, post, destroy};
      return std::strcmp(interface, DIATOM_MACHINE_1) == 0 ? &table : nullptr;
   }
};

} // namespace detail
} // namespace v1
} // namespace diatom::sdk

/// The module of a plugin that provides machines made by one class.
#define DIATOM_MACHINE(Class) DIATOM_MODULE(diatom::sdk::detail::MachineTable<Class>::get)
