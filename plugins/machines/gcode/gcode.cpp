// A generic three-axis pick and place machine and its RS-274 programs. What the interpreter insists on: units
// on a line of their own, a feed before the first G1, no exponents, ASCII, at most 252 characters a line, M2
// at the end.
#include <diatom/machine.hpp>

using namespace diatom::sdk;

namespace {

/// Text that may stand in a parenthesis comment of any controller: ASCII, no parentheses, none of the
/// characters that senders take out of the stream (! ~ %), short enough for the line.
std::string commentText(std::string_view text)
{
   constexpr std::size_t kLongest = 200;
   std::string safe;
   bool inOther = false;
   for (const char c : text) {
      const bool other = c < ' ' || c > '~';
      if (!other || !inOther) // one mark for each run of other bytes
         safe += c == '(' ? '[' : c == ')' ? ']' : other || c == '!' || c == '~' || c == '%' ? '_' : c;
      inOther = other;
   }
   return safe.size() <= kLongest ? safe : safe.substr(0, kLongest - 3) + "...";
}

struct GripWords
{
   std::string close, open;
};

GripWords gripWords(std::string_view choice, int output)
{
   if (choice == "M64/M65")
      return {"M64 P" + std::to_string(output), "M65 P" + std::to_string(output)};
   const std::size_t slash = choice.find('/');
   return {std::string(choice.substr(0, slash)), std::string(choice.substr(slash + 1))};
}

class GcodeMachine : public Machine
{
public:
   GcodeMachine(const Call &, const diatom_create &create) : GcodeMachine(Values(create.values)) {}

   MachineDescription describe() const override { return m_description; }

   void post(const Call &call, const diatom_program &program, ProgramText &text) const override
   {
      Writer writer{*this, text};
      if ((program.piece & DIATOM_PIECE_CONTINUES) == 0)
         writer.heading(program);
      for (std::int64_t i = 0; i < program.count; ++i) {
         if (i % 4096 == 0 && call.cancelled())
            throw Failure(DIATOM_CANCELLED, "cancelled");
         writer.operation(program, i);
      }
      if ((program.piece & DIATOM_PIECE_MORE) == 0)
         text << "M2\n";
   }

private:
   explicit GcodeMachine(const Values &values)
       : m_grip(gripWords(values.text("grip"), static_cast<int>(values.number("grip_output")))),
         m_inch(values.text("unit") == "inch"), m_decimals(static_cast<int>(values.number("decimals")))
   {
      const auto axis = [&](const char *name, int direction, double length, double home) {
         Axis result{name, false, {}, 0, length, home, values.number("rapid"), values.number("acceleration")};
         result.direction[static_cast<std::size_t>(direction)] = 1;
         return result;
      };
      const double height = values.number("work_z");
      m_description.axes = {axis("X", 0, values.number("work_x"), 0),
                            axis("Y", 1, values.number("work_y"), 0), axis("Z", 2, height, height)};
      for (int f = 0; f < static_cast<int>(values.number("feeders")); ++f)
         m_description.feeders.push_back(
             {{values.number("feeder_x"), values.number("feeder_y") + f * values.number("feeder_step"),
               values.number("feeder_z")},
              static_cast<int>(values.number("feeder_columns")),
              static_cast<int>(values.number("feeder_rows")),
              values.number("feeder_pitch")});
      m_description.origin = {values.number("origin_x"), values.number("origin_y"),
                              values.number("origin_z")};
      m_description.clearance = values.number("clearance");
      m_description.approach = values.number("approach");
      m_description.feed = values.number("feed");
      m_description.gripSeconds = values.number("grip_seconds");
      m_description.suffix = "ngc";
   }

   /// Remembers what the controller already knows, so that a line says only what changes.
   struct Writer
   {
      const GcodeMachine &machine;
      ProgramText &text;
      std::array<std::string, 3> at{}; // last word of each axis
      std::string feed{};

      void heading(const diatom_program &program)
      {
         text << "(" << commentText(std::string("design ") + (program.name ? program.name : "")) << ")\n";
         text << "(parts: " << std::to_string(program.parts) << ")\n";
         text << (machine.m_inch ? "G20\n" : "G21\n") << "G17 G90 G94\n" << machine.m_grip.open << "\n";
      }

      void operation(const diatom_program &program, std::int64_t i)
      {
         const double *target = program.target + i * program.axes;
         const int moved = program.moved[i];
         switch (program.op[i]) {
         case DIATOM_OP_RAPID:
            return move("G0", target, moved, {});
         case DIATOM_OP_FEED:
            return move("G1", target, moved, plainText(machine.user(program.feed[i]) * 60, 4));
         case DIATOM_OP_PICK:
            text << machine.m_grip.close << "\n";
            return dwell(program.seconds[i]);
         case DIATOM_OP_PLACE:
            text << machine.m_grip.open << "\n";
            return dwell(program.seconds[i]);
         case DIATOM_OP_DWELL:
            return dwell(program.seconds[i]);
         case DIATOM_OP_NOTE:
            return comment(program, i);
         case DIATOM_OP_HOME:
            move("G0", target, moved & 4, {});
            return move("G0", target, moved & 3, {});
         case DIATOM_OP_PAUSE:
            comment(program, i);
            text << "M0\n";
            return;
         default:
            throw Failure(DIATOM_UNSUPPORTED,
                          "operation " + std::to_string(program.op[i]) + " has no g-code");
         }
      }

      void move(std::string_view word, const double *target, int moved, const std::string &speed)
      {
         std::string line;
         for (std::size_t axis = 0; axis < at.size(); ++axis) {
            if ((moved >> axis & 1) == 0)
               continue;
            const std::string value = fixedText(machine.user(target[axis]), machine.m_decimals);
            if (value != at[axis])
               line += " " + machine.m_description.axes[axis].name + value;
            at[axis] = value;
         }
         if (line.empty())
            return;
         if (!speed.empty() && speed != feed)
            line += " F" + (feed = speed);
         text << word << line << "\n";
      }

      void dwell(double seconds)
      {
         if (seconds > 0)
            text << "G4 P" << plainText(seconds, 6) << "\n";
      }

      void comment(const diatom_program &program, std::int64_t i)
      {
         const char *note = program.note[i] ? program.note[i] : "";
         const std::int64_t part = program.part[i];
         std::string words;
         if (part >= 0) {
            words = "part " + std::to_string(part + 1) + " at";
            for (int k = 0; k < 3; ++k)
               words += " " + std::to_string(program.part_index[3 * part + k]);
            words += " ";
         }
         text << "(" << commentText(words + note) << ")\n";
      }
   };

   /// Metres in the program's unit.
   double user(double metres) const { return m_inch ? metres / 0.0254 : metres * 1000; }

   MachineDescription m_description;
   GripWords m_grip;
   bool m_inch;
   int m_decimals;
};

} // namespace

DIATOM_MACHINE(GcodeMachine)
