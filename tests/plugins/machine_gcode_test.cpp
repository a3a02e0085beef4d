// The generic g-code machine: its programs word for word, their counts and path as an independent RS-274
// interpreter sees them, and what is refused before anything is written.
#include "assembly/motion.h"
#include "assembly/program.h"
#include "core/file.h"
#include "core/text.h"
#include "kernel/assembly_scene.h"
#include "support/process.h"

#include <nlohmann/json.hpp>

#include <clocale>
#include <locale>
#include <sstream>

using namespace diatom;
using namespace diatom::test;

namespace {

const std::string kMachine = "org.diatom_cad.machine.gcode";
const std::string kCube = "org.diatom_cad.lattice.cube";
const std::string kGik = "org.diatom_cad.lattice.gik";

struct Written
{
   Result<ProgramSummary> summary;
   std::string text;
};

Written write(const AssemblyScene &scene, const Values &values = {}, const std::string &name = "test")
{
   Job job;
   const auto machine = Machine::make(*catalogue(), kMachine, values, job);
   if (!machine.ok())
      return {machine.error(), {}};
   const auto plan = planAssembly(*scene.hierarchy, scene.parts, job);
   if (!plan.ok())
      return {plan.error(), {}};
   std::string text;
   auto summary = (*machine)->write(
       *scene.hierarchy, scene.parts, *plan, name, [&](std::string_view piece) { text += piece; }, job);
   return {std::move(summary), text};
}

std::vector<std::string> linesOf(const std::string &text)
{
   std::vector<std::string> lines;
   std::istringstream stream(text);
   for (std::string line; std::getline(stream, line);)
      lines.push_back(line);
   return lines;
}

AssemblyScene block(std::int32_t size, const std::vector<std::string> &materials = {"brass", "steel"})
{
   std::vector<std::vector<Index>> runs;
   std::vector<int> materialOf;
   for (std::int32_t z = 0; z < size; ++z)
      for (std::int32_t y = 0; y < size; ++y)
         for (std::int32_t x = 0; x < size; ++x) {
            runs.push_back({{x, y, z}});
            materialOf.push_back((x + y + z) % static_cast<int>(materials.size()));
         }
   return assemblyOf(kCube, runs, materials, materialOf);
}

/// The interpreter's summary; null (with the reason in `why`) when it cannot be run here.
nlohmann::json interpret(const std::string &text, int &exitCode, QByteArray &why)
{
   const QTemporaryDir folder;
   const std::string file = (std::filesystem::path(folder.path().toStdString()) / "program.ngc").string();
   if (!writeFileAtomic(file, text).ok())
      return nullptr;
   const Outcome canon = run(QString::fromStdString((sharedDir() / "tools" / "gcode_canon").string()),
                             {"--strict", "--max-events", "100000", QString::fromStdString(file)});
   exitCode = canon.exit;
   why = canon.err;
   return nlohmann::json::parse(canon.out.toStdString(), nullptr, false);
}

/// A numpunct as in German: 1.234,5.
class CommaPunctuation : public std::numpunct<char>
{
protected:
   char do_decimal_point() const override { return ','; }
   char do_thousands_sep() const override { return '.'; }
   std::string do_grouping() const override { return "\3"; }
};

} // namespace

class MachineGcodeTest : public QObject
{
   Q_OBJECT

private slots:
   void programsAreThoseOfTheGoldenFile()
   {
      const auto file = readFile(sourceDir() / "plugins" / "machines" / "gcode" / "golden.json");
      DIATOM_VERIFY_OK(file);
      const auto golden = nlohmann::json::parse(*file);
      QVERIFY(golden["cases"].size() >= 3);
      for (const auto &test : golden["cases"]) {
         Values values;
         for (const auto &[name, value] : test["values"].items()) {
            if (value.is_number())
               values[name] = value.get<double>();
            else
               values[name] = value.get<std::string>();
         }
         std::vector<std::vector<Index>> runs;
         for (const auto &run : test["parts"]) {
            runs.emplace_back();
            for (const auto &cell : run)
               runs.back().push_back({cell[0], cell[1], cell[2]});
         }
         const AssemblyScene scene =
             assemblyOf(test["lattice"], runs, test["materials"], test["material_of"]);
         const Written written = write(scene, values, test["name"]);
         DIATOM_VERIFY_OK(written.summary);
         const std::vector<std::string> expected = test["program"];
         const std::vector<std::string> lines = linesOf(written.text);
         for (std::size_t i = 0; i < std::max(lines.size(), expected.size()); ++i) {
            const std::string is = i < lines.size() ? lines[i] : "(nothing)";
            const std::string should = i < expected.size() ? expected[i] : "(nothing)";
            QVERIFY2(is == should, ("line " + std::to_string(i + 1) + " of " +
                                    test["name"].get<std::string>() + ": " + is + " instead of " + should)
                                       .c_str());
         }
      }
   }

   void theInterpreterSeesWhatWasPlanned_data()
   {
      QTest::addColumn<QString>("unit");
      QTest::addColumn<QString>("grip");
      QTest::addColumn<QString>("close");
      QTest::addColumn<QString>("open");
      QTest::newRow("mm, output") << "mm"
                                  << "M64/M65"
                                  << "digital_out"
                                  << "digital_out";
      QTest::newRow("inch, spindle") << "inch"
                                     << "M3/M5"
                                     << "spindle_cw"
                                     << "spindle_off";
      QTest::newRow("mm, mist") << "mm"
                                << "M7/M9"
                                << "mist_on"
                                << "mist_off";
      QTest::newRow("mm, flood") << "mm"
                                 << "M8/M9"
                                 << "flood_on"
                                 << "flood_off";
   }

   void theInterpreterSeesWhatWasPlanned()
   {
      DIATOM_NEEDS_SHARED();
      QFETCH(QString, unit);
      QFETCH(QString, grip);
      const std::int32_t size = 4;
      const AssemblyScene scene = block(size);
      const Written written = write(scene,
                                    {{"unit", unit.toStdString()},
                                     {"grip", grip.toStdString()},
                                     {"grip_seconds", 0.25},
                                     {"decimals", 4.0}},
                                    "caf\xc3\xa9 (50 %!)");
      DIATOM_VERIFY_OK(written.summary);
      int exitCode = 0;
      QByteArray why;
      const auto seen = interpret(written.text, exitCode, why);
      if (exitCode < 0 || why.contains("no rs274"))
         QSKIP(("gcode_canon cannot run here: " + why).constData());
      QVERIFY2(exitCode == 0, why + QByteArray::fromStdString(seen.is_discarded() ? "" : seen.dump()));

      // Per part: up, over, down, feed, pick, feed up, and the same again for placing. The first two moves
      // (home) have the interpreter's own origin to start from; at the end up and sideways home.
      const std::int64_t parts = size * size * size;
      QCOMPARE(written.summary->placements, parts);
      QCOMPARE(seen["motions"]["feed"].get<std::int64_t>(), 4 * parts);
      QCOMPARE(seen["motions"]["rapid"].get<std::int64_t>(), 2 + 6 * parts + 2);
      QCOMPARE(seen["motions"]["zero_length"].get<std::int64_t>(),
               1); // home is where the interpreter starts sideways
      QCOMPARE(seen["dwell_s"].get<double>(), 2 * 0.25 * static_cast<double>(parts));
      QCOMPARE(seen["ended_by"].get<std::string>(), std::string("end word"));
      QFETCH(QString, close);
      QFETCH(QString, open);
      std::int64_t closed = 0, opened = 0;
      for (const auto &event : seen["events"])
         if (!event.contains("by_program_end")) {
            const QString kind = QString::fromStdString(event["event"]);
            closed += kind == close && event.value("on", true) ? 1 : 0;
            opened += kind == open && !event.value("on", false) ? 1 : 0;
         }
      QCOMPARE(closed, parts);
      QCOMPARE(opened, parts + 1); // once to begin with

      // Path: the whole length without the first move. Coordinates have four decimals: 1e-4 mm or 2.5e-3 mm
      // at worst for each of some 640 moves.
      const double path = seen["length"]["rapid"].get<double>() + seen["length"]["feed"].get<double>() -
                          seen["length"]["first_move"].get<double>(); // in mm whatever the program's unit
      QVERIFY2(std::abs(path - 1e3 * written.summary->pathMetres) < 640 * 2.6e-3,
               qPrintable(QString("%1 mm, planned %2 mm").arg(path).arg(1e3 * written.summary->pathMetres)));

      // Box: home, feeders at (20, 20) and (20, 60), the block's far cell at origin + 3.5 pitches.
      QVERIFY(std::abs(seen["bbox"]["x"][1].get<double>() - 103.5) < 3e-3);
      QVERIFY(std::abs(seen["bbox"]["y"][1].get<double>() - 60) < 3e-3);
      QVERIFY(std::abs(seen["bbox"]["z"][1].get<double>() - 200) < 3e-3);
      QVERIFY(std::abs(seen["bbox"]["x"][0].get<double>()) < 3e-3);
   }

   void aLocaleWithCommasChangesNothing()
   {
      const AssemblyScene scene = block(3);
      const std::string before = write(scene).text;
      const char *c = std::setlocale(LC_ALL, "de_DE.UTF-8");
      const std::locale plain = std::locale::global(std::locale(std::locale(), new CommaPunctuation));
      const std::string after = write(scene).text;
      std::locale::global(plain);
      std::setlocale(LC_ALL, "C");
      if (!c)
         qInfo("de_DE.UTF-8 is not installed; checked with a C++ locale only");
      QVERIFY(!before.empty());
      QVERIFY(before == after);
   }

   void everyLineIsPlainAsciiAndShort()
   {
      const Written written = write(block(2), {}, std::string(300, 'x') + "\n(M2) \xff\xfe ~!%");
      DIATOM_VERIFY_OK(written.summary);
      for (const std::string &line : linesOf(written.text)) {
         QVERIFY(line.size() <= 252);
         for (const char c : line)
            QVERIFY2(c >= ' ' && c <= '~' && c != '!' && c != '%' && !(c == '~'), line.c_str());
         const bool comment = line.starts_with("(") && line.find(')') == line.size() - 1;
         QVERIFY2(comment || line.find_first_of("()") == std::string::npos, line.c_str());
      }
   }

   void longProgramsComeInPiecesWithoutASeam()
   {
      // 18^3 = 5832 parts are two pieces. Whatever the piece, each part's lines must be as in any other.
      const AssemblyScene scene = block(18, {"brass"});
      const Written written = write(scene);
      DIATOM_VERIFY_OK(written.summary);
      std::size_t tags = 0, ends = 0, headings = 0;
      for (const std::string &line : linesOf(written.text)) {
         tags += line.starts_with("(part ") ? 1 : 0;
         ends += line == "M2" ? 1 : 0;
         headings += line == "G21" ? 1 : 0;
      }
      QCOMPARE(tags, std::size_t{5832});
      QCOMPARE(ends, std::size_t{1});
      QCOMPARE(headings, std::size_t{1});
      QVERIFY(written.text.ends_with("M2\n"));
      // Part 4097 opens the second piece; it stands on the same layer as part 4098 of the next column.
      const auto body = [&](int part) {
         const std::size_t from = written.text.find("(part " + std::to_string(part) + " ");
         const std::size_t to = written.text.find("(part " + std::to_string(part + 1) + " ");
         return linesOf(written.text.substr(from, to - from)).size();
      };
      QCOMPARE(body(4097), body(4098));
   }

   void travelClearsEverythingPlaced()
   {
      // Reads the program back: whenever the tool moves sideways, it is at least the clearance above all that
      // was placed.
      const AssemblyScene scene = block(5);
      const Written written = write(scene, {{"clearance", 0.003}, {"approach", 0.001}});
      DIATOM_VERIFY_OK(written.summary);
      double z = 0, top = 0;
      bool holding = false;
      for (const std::string &line : linesOf(written.text)) {
         if (line.starts_with("(part "))
            continue;
         if (line.starts_with("M64"))
            holding = true;
         if (line.starts_with("M65")) {
            top = holding ? std::max(top, z + 1) : top; // cells are 1 mm high
            holding = false;
         }
         const std::size_t word = line.find(" Z");
         if (word != std::string::npos)
            z = std::stod(line.substr(word + 2));
         if (line.starts_with("G") &&
             (line.find(" X") != std::string::npos || line.find(" Y") != std::string::npos))
            QVERIFY2(line.starts_with("G0") && z >= top + 3 - 1e-9, line.c_str());
      }
      QCOMPARE(top, 5.0);
   }

   void eachDirectionOfABrickHasAFeeder()
   {
      const AssemblyScene scene = assemblyOf(
          kGik, {{{0, 0, 0}, {0, 1, 0}}, {{1, 0, 0}, {1, 1, 0}}, {{0, 0, 1}, {1, 0, 1}}}, {"brass"});
      const Written written = write(scene);
      DIATOM_VERIFY_OK(written.summary);
      QVERIFY(written.text.find("(feeder 1 holds brass of length 2 direction 1, ") != std::string::npos);
      QVERIFY(written.text.find("(feeder 2 holds brass of length 2 direction 2, ") != std::string::npos);
      QVERIFY(written.summary->byMaterial ==
              (std::vector<std::pair<std::string, std::int64_t>>{{"brass", 3}}));
   }

   void moreKindsThanFeedersAreRefused()
   {
      const Written written = write(block(3, {"brass", "steel", "glass"}), {{"feeders", 2.0}});
      QVERIFY(!written.summary.ok());
      QVERIFY(written.text.empty());
      QVERIFY2(written.summary.error().message.find("3 kinds of part") != std::string::npos &&
                   written.summary.error().message.find("2 feeders") != std::string::npos,
               written.summary.error().message.c_str());
   }

   void whatLiesOutsideTheWorkVolumeIsRefusedBeforeWriting_data()
   {
      QTest::addColumn<QString>("parameter");
      QTest::addColumn<double>("value");
      QTest::addColumn<QString>("words");
      QTest::newRow("part in X") << "origin_x" << 0.398
                                 << "the part at (2, 0, 0) would need the machine's axis X";
      QTest::newRow("part below") << "origin_z" << -0.01 << "axis Z -10 mm, outside its range of 0 to 200 mm";
      QTest::newRow("feeder in Y") << "feeder_y" << 0.5 << "feeder 1 would need the machine's axis Y 500 mm";
      QTest::newRow("travel height") << "clearance" << 0.199 << "axis Z";
      QTest::newRow("last height") << "clearance" << 0.1975 << "pass over the finished assembly";
   }

   void whatLiesOutsideTheWorkVolumeIsRefusedBeforeWriting()
   {
      QFETCH(QString, parameter);
      QFETCH(double, value);
      QFETCH(QString, words);
      const AssemblyScene scene = cellsOf(kCube, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}, {0, 0, 2}});
      const Written written = write(scene, {{parameter.toStdString(), value}});
      QVERIFY(!written.summary.ok());
      QVERIFY(written.text.empty());
      QVERIFY2(QString::fromStdString(written.summary.error().message).contains(words),
               written.summary.error().message.c_str());
   }

   void traysAreEmptiedInRowsAndRefilled()
   {
      const AssemblyScene scene =
          cellsOf(kCube, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}, {6, 0, 0}});
      const Written written =
          write(scene, {{"feeder_columns", 2.0}, {"feeder_rows", 3.0}, {"feeder_pitch", 0.005}});
      DIATOM_VERIFY_OK(written.summary);
      std::vector<std::string> picks;
      double x = 0, y = 0;
      for (const std::string &line : linesOf(written.text)) {
         if (const auto at = line.find(" X"); at != std::string::npos)
            x = *parseNumber(line.substr(at + 2, line.find(' ', at + 2) - at - 2));
         if (const auto at = line.find(" Y"); at != std::string::npos)
            y = *parseNumber(line.substr(at + 2, line.find(' ', at + 2) - at - 2));
         if (line.starts_with("M64"))
            picks.push_back(numberText(x) + " " + numberText(y));
         if (line == "M0")
            picks.push_back("refill");
      }
      QVERIFY(picks == std::vector<std::string>(
                           {"20 20", "25 20", "20 25", "25 25", "20 30", "25 30", "refill", "20 20"}));
      QCOMPARE(written.summary->problems.size(), std::size_t{1});
      QCOMPARE(written.summary->problems[0].kind, std::string("feeder-refill"));
   }

   void anEmptyPlanIsAValidProgram()
   {
      const Written written = write(assemblyOf(kCube, {}));
      DIATOM_VERIFY_OK(written.summary);
      QCOMPARE(written.summary->placements, std::int64_t{0});
      QCOMPARE(written.summary->seconds, 0.0);
      QVERIFY(written.text.ends_with("M2\n"));
   }

   void timesAreThoseOfTrapezoids()
   {
      // Rapid 50 mm/s, 500 mm/s2: 40 mm along X take 40/50 + 50/500 = 0.9 s; 2 mm do not reach full speed
      // (ramps take 5 mm) and take 2 sqrt(2/500) s; feeding 2 mm at 5 mm/s takes 0.4 + 5/500 s. Along the
      // diagonal of X and Y both axes run at their limits: sqrt(2) times as fast, the same time as along one
      // axis. Exact but for rounding.
      Job job;
      const auto machine = Machine::make(*catalogue(), kMachine, {}, job);
      DIATOM_VERIFY_OK(machine);
      const Motion motion((*machine)->description());
      const Vec3 zero = Vec3::Zero();
      QVERIFY(std::abs(motion.seconds(zero, {0.04, 0, 0}, 0) - 0.9) < 1e-12);
      QVERIFY(std::abs(motion.seconds(zero, {0, 0, 0.002}, 0) - 2 * std::sqrt(0.002 / 0.5)) < 1e-12);
      QVERIFY(std::abs(motion.seconds(zero, {0, 0, -0.002}, 0.005) - 0.41) < 1e-12);
      QVERIFY(std::abs(motion.seconds(zero, {0.04, 0.04, 0}, 0) - 0.9) < 1e-12);
      QCOMPARE(motion.seconds(zero, zero, 0), 0.0);
   }

   void pathAndTimeOfOnePartAreTheSumOfItsMoves()
   {
      // One 1 mm cube, defaults: home (0, 0, 200), travel at 6 (feeder top 1 + clearance 5), feeder (20, 20,
      // 0), target (100.5, 20.5, 0), approach 2, and home, up first. Lengths in mm, hence times by hand.
      const Written written = write(cellsOf(kCube, {{3, -8, 2}}));
      DIATOM_VERIFY_OK(written.summary);
      const double over = std::hypot(20.0, 20.0), across = std::hypot(80.5, 0.5),
                   back = std::hypot(100.5, 20.5);
      const double path = 194 + over + 4 + 2 + 2 + 4 + across + 4 + 2 + 2 + 198 + back;
      QVERIFY(std::abs(1e3 * written.summary->pathMetres - path) < 1e-9);
      const auto rapid = [](double length) { // of the axis that goes furthest
         return length > 5 ? length / 50 + 0.1 : 2 * std::sqrt(length / 500);
      };
      const double time = rapid(194) + rapid(20) + rapid(4) + 0.41 + 0.5 + 0.41 + rapid(4) + rapid(80.5) +
                          rapid(4) + 0.41 + 0.5 + 0.41 + rapid(198) + rapid(100.5);
      QVERIFY2(std::abs(written.summary->seconds - time) < 1e-9,
               qPrintable(QString("%1 s, by hand %2 s").arg(written.summary->seconds).arg(time)));
   }

   void descriptionsThatMakeNoSenseAreNamed()
   {
      Job job;
      const auto machine = Machine::make(*catalogue(), kMachine, {}, job);
      DIATOM_VERIFY_OK(machine);
      diatom_machine_description description = (*machine)->description();
      QCOMPARE(checkDescription(description), std::string());
      description.feed = 0;
      QVERIFY(!checkDescription(description).empty());
      description = (*machine)->description();
      description.axes = 2;
      QVERIFY(checkDescription(description).find("three independent sliding axes") != std::string::npos);
      description = (*machine)->description();
      const double flat[] = {1, 0, 0, 0, 1, 0, 0, 1, 0};
      description.axis_direction = flat;
      QVERIFY(!checkDescription(description).empty());
      const double nan[] = {1, 0, 0, 0, 1, 0, 0, 0, std::nan("")};
      description.axis_direction = nan;
      QVERIFY(checkDescription(description).find("axis Z") != std::string::npos);
      description = (*machine)->description();
      description.size = 16;
      QVERIFY(!checkDescription(description).empty());
   }
};

QTEST_GUILESS_MAIN(MachineGcodeTest)
#include "machine_gcode_test.moc"
