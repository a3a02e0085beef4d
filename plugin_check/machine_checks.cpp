// Whether a machine is one that can be driven, and whether its programs are the same bytes on every computer.
#include "plugin_check/checks.h"
#include "plugin_check/thing.h"

#include "assembly/motion.h"
#include "assembly/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <clocale>
#include <cmath>
#include <string_view>

namespace diatom::check {

namespace {

constexpr std::int64_t kShort = 200, kLong = 1'000'000, kPiece = 4096; // operations

/// Where targets of a program are: places that the machine itself names, or anywhere within its axes' ranges.
enum class Targets { named, anywhere };

/// Axis values of the places that the description names: home, the feeders and where the assembly stands.
std::vector<std::vector<double>> namedTargets(const diatom_machine_description &machine)
{
   const std::vector<double> home(machine.axis_home, machine.axis_home + machine.axes);
   const Motion motion(machine);
   std::vector<std::vector<double>> targets{home};
   const auto add = [&](const Vec3 &tool) {
      const Vec3 axes = motion.axesAt(tool);
      std::vector<double> target = home;
      for (int k = 0; k < 3; ++k)
         target[static_cast<std::size_t>(motion.axis(k))] = axes[k];
      if (motion.outside(tool).empty())
         targets.push_back(std::move(target));
   };
   for (std::int32_t f = 0; f < machine.feeders; ++f)
      add(Eigen::Map<const Vec3>(machine.feeder_position + 3 * f));
   add(Eigen::Map<const Vec3>(machine.origin));
   return targets;
}

/// A program of random operations; owns what the record points to.
class Program
{
public:
   Program(const diatom_machine_description &machine, std::int64_t count, std::mt19937_64 random,
           Targets targets = Targets::named)
       : m_axes(machine.axes)
   {
      const auto named = namedTargets(machine);
      for (std::int64_t i = 0; i < count; ++i) {
         const auto op = static_cast<std::int32_t>(random() % (DIATOM_OP_PAUSE + 1));
         const bool moves = op == DIATOM_OP_RAPID || op == DIATOM_OP_FEED || op == DIATOM_OP_HOME;
         const bool grips = op == DIATOM_OP_PICK || op == DIATOM_OP_PLACE;
         m_op.push_back(op);
         m_moved.push_back(moves ? (1 << m_axes) - 1 : 0);
         const std::vector<double> target =
             targets == Targets::named ? named[random() % named.size()] : anywhere(machine, random);
         m_target.insert(m_target.end(), target.begin(), target.end());
         m_feed.push_back(op == DIATOM_OP_FEED ? machine.feed : 0);
         m_seconds.push_back(grips ? machine.grip_seconds : op == DIATOM_OP_DWELL ? 0.25 : 0);
         m_part.push_back(grips ? m_parts : -1);
         m_note.push_back(grips || op == DIATOM_OP_NOTE || op == DIATOM_OP_PAUSE
                              ? "a part (of steel), 1/2 long"
                              : nullptr);
         if (grips) {
            m_feeder.push_back(machine.feeders > 0 ? static_cast<std::int32_t>(m_parts % machine.feeders)
                                                   : 0);
            m_index.insert(m_index.end(), {static_cast<std::int32_t>(m_parts), -1, 2});
            ++m_parts;
         }
      }
   }

   /// The operations from `first`, at most `count`, as a piece of the whole.
   diatom_program piece(std::int64_t first, std::int64_t count) const
   {
      const auto all = static_cast<std::int64_t>(m_op.size());
      const std::int64_t now = std::min(count, all - first);
      diatom_program record{};
      record.size = sizeof record;
      record.count = now;
      record.axes = m_axes;
      record.piece = (first > 0 ? DIATOM_PIECE_CONTINUES : 0) | (first + now < all ? DIATOM_PIECE_MORE : 0);
      record.op = m_op.data() + first;
      record.moved = m_moved.data() + first;
      record.target = m_target.data() + first * m_axes;
      record.feed = m_feed.data() + first;
      record.seconds = m_seconds.data() + first;
      record.part = m_part.data() + first;
      record.note = m_note.data() + first;
      record.name = "checked";
      record.parts = m_parts;
      record.part_feeder = m_feeder.data();
      record.part_index = m_index.data();
      return record;
   }
   std::int64_t count() const { return static_cast<std::int64_t>(m_op.size()); }

private:
   static std::vector<double> anywhere(const diatom_machine_description &machine, std::mt19937_64 &random)
   {
      constexpr double kFarthest = 1e3; // m; ranges may be without end
      std::vector<double> target;
      for (int a = 0; a < machine.axes; ++a)
         target.push_back(
             std::uniform_real_distribution<double>(std::max(machine.axis_minimum[a], -kFarthest),
                                                    std::min(machine.axis_maximum[a], kFarthest))(random));
      return target;
   }

   std::int32_t m_axes;
   std::int64_t m_parts = 0;
   std::vector<std::int32_t> m_op, m_moved, m_feeder, m_index;
   std::vector<double> m_target, m_feed, m_seconds;
   std::vector<std::int64_t> m_part;
   std::vector<const char *> m_note;
};

struct Made
{
   std::shared_ptr<const Machine> machine; // as the kernel has checked it
   std::shared_ptr<const Instance> instance;
};

Result<Made> makeMachine(const Subject &subject, const Values &values, const Job &job)
{
   auto instance =
       subject.catalogue->create<diatom_machine>(DIATOM_MACHINE_1, subject.provided->id, values, job);
   if (!instance)
      return instance.error();
   auto machine = Machine::make(*subject.catalogue, subject.provided->id, values, job);
   if (!machine)
      return fault(machine.error());
   return Made{*std::move(machine), *std::move(instance)};
}

std::int32_t takeText(const diatom_text_sink *sink, const char *bytes, std::int64_t count)
{
   if (count < 0 || (count > 0 && !bytes))
      return DIATOM_BAD_INPUT;
   static_cast<std::string *>(sink->host)->append(bytes, static_cast<std::size_t>(count));
   return DIATOM_OK;
}

Result<std::string> post(const Instance &instance, const Program &program, const Job &job)
{
   std::string text;
   const diatom_text_sink sink{sizeof sink, &text, takeText};
   for (std::int64_t first = 0; first == 0 || first < program.count(); first += kPiece) {
      const diatom_program piece = program.piece(first, kPiece);
      const Status posted = instance.call("post", job, [&](const diatom_call *call) {
         return instance.table<diatom_machine>()->post(instance.self(), call, &piece, &sink);
      });
      if (!posted)
         return posted.error();
   }
   return text;
}

/// A word of the text that a number which is none is printed as.
std::string notANumber(const std::string &text)
{
   std::string word;
   for (const char c : text + " ") {
      if (std::isalpha(static_cast<unsigned char>(c))) {
         word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
         continue;
      }
      constexpr std::size_t kWithAxis = 4; // "xnan": a letter of the program before the number
      if (word.size() <= kWithAxis && (word.ends_with("nan") || word.ends_with("inf")))
         return word;
      word.clear();
   }
   return {};
}

void checkMachinePrograms(const Subject &subject, Findings &findings)
{
   for (const Choice &choice : parameterChoices(subject, 3)) {
      const auto made = makeMachine(subject, choice.values, Job());
      if (!made)
         continue; // told by the check of parameters
      for (const std::int64_t count : {std::int64_t{0}, kShort, kPiece + 1}) {
         const Program program(made->machine->description(), count, subject.random("program"));
         const auto text = post(*made->instance, program, Job()),
                    again = post(*made->instance, program, Job());
         const std::string label = fmt::format("with {}: a program of {} operations", choice.label, count);
         if (!text && (choice.values.empty() || text.error().code == ErrorCode::internal))
            findings.fail(label + ": " + text.error().message);
         else if (!text)
            continue; // with these values the places lie out of its reach, and it says so
         else if (!again || *again != *text)
            findings.fail(label + " is other bytes the second time");
         else if (const std::string word = notANumber(*text); !word.empty())
            findings.fail(fmt::format("{} holds \"{}\" where a number belongs", label, word));
      }
   }
}

/// Points that no arm may reach: told, never written down as something else.
void checkMachineReach(const Subject &subject, Findings &findings)
{
   const auto made = makeMachine(subject, {}, Job());
   if (!made)
      return findings.fail(made.error().message);
   auto random = subject.random("reach");
   for (int i = 0; i < kShort; ++i) {
      const Program program(made->machine->description(), 8, std::mt19937_64(random()), Targets::anywhere);
      const auto text = post(*made->instance, program, Job());
      if (!text && text.error().code == ErrorCode::internal)
         return findings.fail("a program within the ranges of its axes: " + text.error().message);
      if (text && !notANumber(*text).empty())
         return findings.fail("a program within the ranges of its axes holds numbers that are none");
   }
}

void checkMachineLocale(const Subject &subject, Findings &findings)
{
   const auto made = makeMachine(subject, {}, Job());
   if (!made)
      return findings.fail(made.error().message);
   const Program program(made->machine->description(), kShort, subject.random("locale"));
   const auto expected = post(*made->instance, program, Job());
   const std::string before = std::setlocale(LC_ALL, nullptr);
   const char *comma = nullptr;
   for (const char *name :
        {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "nl_NL.UTF-8", "es_ES.UTF-8", "ru_RU.UTF-8"})
      comma = comma ? comma : std::setlocale(LC_ALL, name);
   const auto found = post(*made->instance, program, Job());
   std::setlocale(LC_ALL, before.c_str());
   if (!comma)
      return findings.skip("no locale with a decimal comma is installed here (Debian: locales, de_DE.UTF-8)");
   if (!expected || !found || *expected != *found)
      findings.fail(
          "under a locale with a decimal comma its programs have other bytes: make numbers into text "
          "without printf and streams (std::to_chars)");
}

void checkMachineLong(const Subject &subject, Findings &findings)
{
   const auto made = makeMachine(subject, {}, Job());
   if (!made)
      return findings.fail(made.error().message);
   const Program program(made->machine->description(), kLong, subject.random("long"));
   const auto text = post(*made->instance, program, Job());
   if (!text)
      findings.fail(fmt::format("a program of {} operations: {}", kLong, text.error().message));
}

void checkMachineCancel(const Subject &subject, Findings &findings)
{
   const auto made = makeMachine(subject, {}, Job());
   if (!made)
      return findings.fail(made.error().message);
   const Program program(made->machine->description(), kLong, subject.random("cancel"));
   const auto seconds = secondsToCancel([&](const Job &job) {
      std::string text;
      const diatom_text_sink sink{sizeof sink, &text, takeText};
      const diatom_program whole = program.piece(0, kLong);
      (void)made->instance->call("post", job, [&](const diatom_call *call) {
         return made->instance->table<diatom_machine>()->post(made->instance->self(), call, &whole, &sink);
      });
   });
   if (seconds && *seconds > kCancelSeconds)
      findings.warn(
          fmt::format("cancelled while it writes {} operations, it goes on for {:.0f} ms, more than {:.0f}: "
                      "look at cancelled() at least every 50 ms",
                      kLong, *seconds * 1e3, kCancelSeconds * 1e3));
}

class MachineThing : public Thing
{
public:
   MachineThing(Made made, Program program) : m_made(std::move(made)), m_program(std::move(program)) {}

   Result<Hash> answers(const Job &job) const override
   {
      const auto text = post(*m_made.instance, m_program, job);
      if (!text)
         return text.error();
      const diatom_machine_description &m = m_made.machine->description();
      Hasher hasher;
      hasher.add(*text);
      for (const double *values :
           {m.axis_minimum, m.axis_maximum, m.axis_home, m.axis_speed, m.axis_acceleration})
         hasher.add(std::span(values, static_cast<std::size_t>(m.axes)));
      hasher.add(std::span(m.axis_direction, 3 * static_cast<std::size_t>(m.axes)));
      hasher.add(std::span(m.feeder_position, 3 * static_cast<std::size_t>(m.feeders)));
      return hasher.finish();
   }

private:
   Made m_made;
   Program m_program;
};

} // namespace

Result<std::unique_ptr<const Thing>> makeMachineThing(const Subject &subject, const Values &values,
                                                      const Job &job)
{
   auto made = makeMachine(subject, values, job);
   if (!made)
      return made.error();
   Program program(made->machine->description(), kShort, subject.random("answers"));
   return std::unique_ptr<const Thing>(std::make_unique<MachineThing>(*std::move(made), std::move(program)));
}

void addMachineChecks(std::vector<Check> &checks)
{
   checks.push_back({"machine.programs", "programs, the empty one among them, are the same bytes each time",
                     DIATOM_MACHINE_1, checkMachinePrograms});
   checks.push_back({"machine.reach", "what it cannot reach it refuses with a reason", DIATOM_MACHINE_1,
                     checkMachineReach});
   checks.push_back({"machine.locale", "and in a country that writes decimal commas", DIATOM_MACHINE_1,
                     checkMachineLocale});
   checks.push_back(
       {"machine.long", "it writes a program of a million operations", DIATOM_MACHINE_1, checkMachineLong});
   checks.push_back(
       {"machine.cancel", "it stops soon after it is cancelled", DIATOM_MACHINE_1, checkMachineCancel});
}

} // namespace diatom::check
