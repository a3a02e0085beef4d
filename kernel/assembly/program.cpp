#include "assembly/program.h"

#include "core/check.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

/// Placings between two calls of the sink: some megabytes of operations.
constexpr std::int64_t kPieceParts = 4096;

/// Moves the tool through the layout, keeps the operations not yet handed over, and adds up path and time.
class ProgramMaker
{
public:
   ProgramMaker(const Layout &layout, const diatom_machine_description &machine, const std::string &name,
                const PieceSink &sink)
       : m_layout(layout), m_machine(machine), m_motion(machine), m_name(name), m_sink(sink),
         m_tool(m_motion.toolAt(m_motion.home())), m_top(std::max(layout.feederTop, machine.origin[2]))
   {}

   Result<ProgramLength> run(const Job &job)
   {
      if (Status status = checkHeights(); !status)
         return status.error();
      begin();
      const auto count = static_cast<std::int64_t>(m_layout.placings.size());
      for (std::int64_t i = 0; i < count; ++i) {
         if (i > 0 && i % kPieceParts == 0) {
            if (job.cancelled())
               return Error{ErrorCode::cancelled, "writing the machine program was cancelled"};
            job.progress(static_cast<double>(i) / static_cast<double>(count), "writing the machine program");
            if (Status status = flush(DIATOM_PIECE_MORE); !status)
               return status.error();
         }
         fetchAndPlace(i);
      }
      goHome();
      if (Status status = flush(0); !status)
         return status.error();
      return m_length;
   }

private:
   struct Feed
   {
      Vec3 position;
      bool empty; // its tray has to be filled again first
   };

   Feed feedOf(const Placing &placing) const
   {
      const int f = placing.feeder;
      const std::int64_t columns = m_machine.feeder_columns[f], places = columns * m_machine.feeder_rows[f];
      const std::int64_t place = placing.turn % places, row = place / columns;
      const Vec3 step(static_cast<double>(place % columns), static_cast<double>(row), 0);
      return {Eigen::Map<const Vec3>(m_machine.feeder_position + 3 * f) + m_machine.feeder_pitch[f] * step,
              places > 1 && place == 0 && placing.turn > 0};
   }

   /// Height at which nothing is in the way of the part that hangs from the tool.
   double travelHeight(double pick, double place) const
   {
      return std::max(m_top + m_machine.clearance, std::max(pick, place) + m_machine.approach);
   }

   double topAfter(const Placing &placing) const
   {
      return std::max(m_top, placing.target.z() + placing.height);
   }

   /// Every height and feeder of the program against the axes' ranges, before anything is written.
   Status checkHeights()
   {
      const double start = m_top;
      for (const Placing &placing : m_layout.placings) {
         const Vec3 pick = feedOf(placing).position;
         const double travel = travelHeight(pick.z(), placing.target.z());
         for (const Vec3 &point : {pick, Vec3(pick.x(), pick.y(), travel)})
            if (const std::string out = m_motion.outside(point); !out.empty())
               return Error{
                   ErrorCode::invalid,
                   fmt::format("feeder {} would need the machine's axis {}: move the feeder, lower the "
                               "clearance or use a larger machine",
                               placing.feeder + 1, out)};
         m_top = topAfter(placing);
      }
      const Vec3 last(m_tool.x(), m_tool.y(), m_top + m_machine.clearance);
      if (const std::string out = m_motion.outside(last); !out.empty() && !m_layout.placings.empty())
         return Error{
             ErrorCode::invalid,
             fmt::format("to pass over the finished assembly the machine would need its axis {}: lower "
                         "the clearance or use a larger machine",
                         out)};
      m_top = start;
      return {};
   }

   void add(int op, std::int64_t part, double seconds, const char *note)
   {
      m_op.push_back(op);
      m_moved.push_back(0);
      m_target.insert(m_target.end(), m_machine.axis_home, m_machine.axis_home + m_machine.axes);
      const Vec3 axes = m_motion.axesAt(m_tool);
      for (int k = 0; k < 3; ++k)
         m_target[m_target.size() - static_cast<std::size_t>(m_machine.axes - m_motion.axis(k))] = axes[k];
      m_feed.push_back(m_machine.feed);
      m_seconds.push_back(seconds);
      m_part.push_back(part);
      m_note.push_back(note);
      m_length.seconds += seconds;
   }

   void move(int op, const Vec3 &tool)
   {
      const Vec3 from = m_motion.axesAt(m_tool), to = m_motion.axesAt(tool);
      int moved = 0;
      for (int k = 0; k < 3; ++k)
         moved |= from[k] != to[k] ? 1 << m_motion.axis(k) : 0;
      if (moved == 0)
         return;
      m_length.pathMetres += (tool - m_tool).norm();
      m_length.seconds += m_motion.seconds(from, to, op == DIATOM_OP_FEED ? m_machine.feed : 0);
      m_tool = tool;
      add(op, -1, 0, nullptr);
      m_moved.back() = moved;
   }

   void moveHeight(int op, double height) { move(op, Vec3(m_tool.x(), m_tool.y(), height)); }

   void begin()
   {
      for (std::size_t f = 0; f < m_layout.stocks.size(); ++f)
         m_words.push_back(fmt::format("feeder {} holds {}, {} in all", f + 1, m_layout.stocks[f].label,
                                       m_layout.stocks[f].parts));
      for (const std::string &words : m_words)
         add(DIATOM_OP_NOTE, -1, 0, words.c_str());
      for (std::size_t f = 0; f < m_layout.stocks.size(); ++f)
         m_refill.push_back(fmt::format("refill feeder {} with {}", f + 1, m_layout.stocks[f].label));
      add(DIATOM_OP_HOME, -1, 0, nullptr); // where it stands already: path and time begin here
      m_moved.back() = (1 << m_machine.axes) - 1;
   }

   void fetchAndPlace(std::int64_t number)
   {
      const Placing &placing = m_layout.placings[static_cast<std::size_t>(number)];
      const auto feeder = static_cast<std::size_t>(placing.feeder);
      const auto [pick, empty] = feedOf(placing);
      const Vec3 &place = placing.target;
      const double travel = travelHeight(pick.z(), place.z());

      add(DIATOM_OP_NOTE, number, 0, m_layout.stocks[feeder].label.c_str());
      moveHeight(DIATOM_OP_RAPID, travel);
      if (empty)
         add(DIATOM_OP_PAUSE, -1, 0, m_refill[feeder].c_str());
      visit(pick, travel, DIATOM_OP_PICK, number);
      moveHeight(DIATOM_OP_RAPID, travel);
      visit(place, travel, DIATOM_OP_PLACE, number);
      m_top = topAfter(placing);
   }

   /// From travel height down to the point, switch the gripper, and up again to where feeding began.
   void visit(const Vec3 &point, double travel, int gripper, std::int64_t number)
   {
      move(DIATOM_OP_RAPID, Vec3(point.x(), point.y(), travel));
      moveHeight(DIATOM_OP_RAPID, point.z() + m_machine.approach);
      moveHeight(DIATOM_OP_FEED, point.z());
      add(gripper, number, m_machine.grip_seconds, nullptr);
      moveHeight(DIATOM_OP_FEED, point.z() + m_machine.approach);
   }

   void goHome()
   {
      const Vec3 home = m_motion.toolAt(m_motion.home());
      const double travel = m_top + m_machine.clearance;
      if (!m_layout.placings.empty() && home.z() < travel)
         moveHeight(DIATOM_OP_RAPID, travel);
      const Vec3 above(m_tool.x(), m_tool.y(), home.z());
      for (const Vec3 &step : {above, home}) {
         m_length.pathMetres += (step - m_tool).norm();
         m_length.seconds += m_motion.seconds(m_motion.axesAt(m_tool), m_motion.axesAt(step), 0);
         m_tool = step;
      }
      add(DIATOM_OP_HOME, -1, 0, nullptr);
      m_moved.back() = (1 << m_machine.axes) - 1;
   }

   Status flush(int more)
   {
      diatom_program program{};
      program.size = sizeof program;
      program.count = static_cast<std::int64_t>(m_op.size());
      program.axes = m_machine.axes;
      program.piece = more | (m_pieces++ > 0 ? DIATOM_PIECE_CONTINUES : 0);
      program.op = m_op.data();
      program.moved = m_moved.data();
      program.target = m_target.data();
      program.feed = m_feed.data();
      program.seconds = m_seconds.data();
      program.part = m_part.data();
      program.note = m_note.data();
      program.name = m_name.c_str();
      program.parts = static_cast<std::int64_t>(m_layout.placings.size());
      program.part_feeder = m_layout.partFeeder.data();
      program.part_index = m_layout.partIndex.data();
      Status status = m_sink(program);
      m_op.clear();
      m_moved.clear();
      m_target.clear();
      m_feed.clear();
      m_seconds.clear();
      m_part.clear();
      m_note.clear();
      return status;
   }

   const Layout &m_layout;
   const diatom_machine_description &m_machine;
   Motion m_motion;
   const std::string &m_name;
   const PieceSink &m_sink;
   Vec3 m_tool;  // where the tool stands
   double m_top; // of everything placed so far and of what the feeders hold
   std::vector<std::string> m_words, m_refill;
   int m_pieces = 0;
   ProgramLength m_length;

   std::vector<std::int32_t> m_op, m_moved;
   std::vector<double> m_target, m_feed, m_seconds;
   std::vector<std::int64_t> m_part;
   std::vector<const char *> m_note;
};

} // namespace

Result<ProgramLength> writeProgram(const Layout &layout, const diatom_machine_description &machine,
                                   const std::string &name, const PieceSink &sink, const Job &job)
{
   return ProgramMaker(layout, machine, name, sink).run(job);
}

} // namespace diatom
