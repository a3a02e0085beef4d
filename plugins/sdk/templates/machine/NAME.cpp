// A polar pick and place machine: a column that turns (C), an arm on it that slides in and out (R) and up and
// down (Z), and a wrist (A) that turns the gripper back by as much as the column turned, so that every part
// keeps its direction.
//
// Diatom plans where the tool goes, in X, Y and Z; this file says how the joints get it there. Between the
// heights of feeder, travel and placing the tool moves straight up and down, where joints and space agree;
// what it crosses at travel height it crosses in joints, along an arc.
#include <diatom/machine.hpp>

#include <cmath>

using namespace diatom::sdk;

namespace {

const double kPi = std::acos(-1.0);

/// Where the joints stand; metres and radians.
struct Joints
{
   double radius = 0, height = 0, column = 0, wrist = 0;
};

class PolarMachine : public Machine
{
public:
   PolarMachine(const Call &, const diatom_create &create) : PolarMachine(Values(create.values)) {}

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
   explicit PolarMachine(const Values &values)
       : m_inner(values.number("inner")), m_outer(values.number("outer"))
   {
      if (!(m_inner < m_outer))
         throw Failure(DIATOM_BAD_INPUT,
                       "the arm's shortest reach must be less than its longest; set inner below outer");
      const double height = values.number("height"), speed = values.number("rapid"),
                   ramp = values.number("acceleration");
      const auto sliding = [&](const char *name, std::array<double, 3> along, double low, double high,
                               double home) {
         return Axis{name, false, along, low, high, home, speed, ramp};
      };
      const auto turning = [&](const char *name) {
         return Axis{name, true, {0, 0, 1}, -kPi, kPi, 0, speed / m_outer, ramp / m_outer};
      };
      // X, Y and Z are what the tool does in space; post() makes R, C and A of the first two.
      m_description.axes = {sliding("X", {1, 0, 0}, -m_outer, m_outer, m_inner),
                            sliding("Y", {0, 1, 0}, -m_outer, m_outer, 0),
                            sliding("Z", {0, 0, 1}, 0, height, height), turning("C"), turning("A")};
      // Feeders stand on an arc about the column, at one reach, each turned away from the assembly by a step.
      for (int f = 0; f < static_cast<int>(values.number("feeders")); ++f) {
         const double angle = kPi / 2 + f * values.number("feeder_angle"),
                      reach = values.number("feeder_reach");
         m_description.feeders.push_back({{reach * std::cos(angle), reach * std::sin(angle), 0}, 1, 1, 0});
      }
      m_description.origin = {values.number("origin_x"), values.number("origin_y"), 0};
      m_description.clearance = values.number("clearance");
      m_description.approach = values.number("approach");
      m_description.feed = values.number("feed");
      m_description.gripSeconds = values.number("grip_seconds");
      m_description.suffix = "ngc";
   }

   /// Joints for a point of the tool. The column takes the one angle within half a turn either way, so that
   /// hoses never wind up, however long the program is.
   Joints jointsAt(double x, double y, double z) const
   {
      const double radius = std::hypot(x, y);
      constexpr double kRounding = 1e-9;
      if (radius < m_inner - kRounding || radius > m_outer + kRounding)
         throw Failure(DIATOM_BAD_INPUT,
                       "the point " + fixedText(x * 1e3, 1) + ", " + fixedText(y * 1e3, 1) + " mm lies " +
                           fixedText(radius * 1e3, 1) + " mm from the column, which reaches from " +
                           fixedText(m_inner * 1e3, 1) + " to " + fixedText(m_outer * 1e3, 1) +
                           " mm; move the assembly or its feeders (origin_x, origin_y, feeder_reach)");
      const double column = std::atan2(y, x);
      return {radius, z, column, -column};
   }

   /// Says only what changes from line to line.
   struct Writer
   {
      const PolarMachine &machine;
      ProgramText &text;
      std::array<std::string, 4> at{}; // last word of each joint
      std::string feed{};

      void heading(const diatom_program &program)
      {
         text << "(parts: " << std::to_string(program.parts) << ")\nG21\nG90 G94\nM65 P0\n";
      }

      void operation(const diatom_program &program, std::int64_t i)
      {
         const double *target = program.target + i * program.axes;
         switch (program.op[i]) {
         case DIATOM_OP_RAPID:
            return move("G0", target, {});
         case DIATOM_OP_FEED:
            return move("G1", target, plainText(program.feed[i] * 60e3, 3));
         case DIATOM_OP_HOME: // up before aside
            write("G0", {at[0], fixedText(target[2] * 1e3, 3), at[2], at[3]}, {});
            return move("G0", target, {});
         case DIATOM_OP_PICK:
         case DIATOM_OP_PLACE:
            text << (program.op[i] == DIATOM_OP_PICK ? "M64 P0\n" : "M65 P0\n");
            return dwell(program.seconds[i]);
         case DIATOM_OP_DWELL:
            return dwell(program.seconds[i]);
         case DIATOM_OP_NOTE:
         case DIATOM_OP_PAUSE:
            note(program, i);
            if (program.op[i] == DIATOM_OP_PAUSE)
               text << "M0\n";
            return;
         default:
            throw Failure(DIATOM_UNSUPPORTED,
                          "operation " + std::to_string(program.op[i]) + " has no words here");
         }
      }

      void move(std::string_view word, const double *target, const std::string &speed)
      {
         const Joints j = machine.jointsAt(target[0], target[1], target[2]);
         const double degree = 180 / kPi;
         write(word,
               {fixedText(j.radius * 1e3, 3), fixedText(j.height * 1e3, 3), fixedText(j.column * degree, 4),
                fixedText(j.wrist * degree, 4)},
               speed);
      }

      void write(std::string_view word, const std::array<std::string, 4> &to, const std::string &speed)
      {
         constexpr std::array<const char *, 4> kLetters{"R", "Z", "C", "A"};
         std::string line;
         for (std::size_t joint = 0; joint < at.size(); ++joint)
            if (to[joint] != at[joint])
               line += std::string(" ") + kLetters[joint] + to[joint];
         at = to;
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

      /// A comment may hold no parenthesis and nothing but ASCII.
      void note(const diatom_program &program, std::int64_t i)
      {
         std::string words = program.note[i] ? program.note[i] : "";
         for (char &c : words)
            c = c < ' ' || c > '~' || c == '(' || c == ')' ? '_' : c;
         const std::int64_t part = program.part[i];
         text << "(" << (part >= 0 ? "part " + std::to_string(part + 1) + " " : std::string())
              << words.substr(0, 200) << ")\n";
      }
   };

   MachineDescription m_description;
   double m_inner, m_outer;
};

} // namespace

DIATOM_MACHINE(PolarMachine)
