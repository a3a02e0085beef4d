// The command line as a user calls it: what each command prints and writes, and how it fails.
#include "cli/program.h"
#include "core/file.h"
#include "io/mesh_read.h"

#include <numbers>

using namespace diatom;
using test::diatomRuns;
using Outcome = test::Printed;
namespace fs = std::filesystem;

namespace {

QString sample(const char *name) { return QString::fromStdString((test::samplesDir() / name).string()); }

} // namespace

class CommandsTest : public QObject
{
   Q_OBJECT
private slots:
   void init() { m_dir = std::make_unique<QTemporaryDir>(); }
   void helpAndVersionGoToStandardOutput();
   void everyCommandHasHelp();
   void misuseExitsWithTwo();
   void unreadableInputExitsWithThree();
   void aPlaceThatCannotBeWrittenExitsWithFour();
   void aMeshBecomesCells();
   void turnsTheLatticeDoesNotHaveAreRefused();
   void infoPrintsTheAgreedKeys();
   void aMissingLatticeIsToldAndTheDesignKept();
   void standardInputIsAFileToo();
   void simulateReportsAndRecords();
   void aStepThatCannotBeStableIsRefused();
   void exportWritesOneFilePerMaterial();
   void planWritesAProgram();
   void renderWritesAPicture();
   void renderDrawsPartsAndStruts();
   void convertKeepsTheDesign();
   void doAndReplayMakeTheSameDesign();
   void checkFindsAConflictAndExitsWithFive();
   void pipelineDoesTheMainJob();
   void everyPluginOfOursIsAccepted();

private:
   QString file(const char *name) const { return m_dir->filePath(name); }
   std::unique_ptr<QTemporaryDir> m_dir;
};

void CommandsTest::helpAndVersionGoToStandardOutput()
{
   const Outcome help = diatomRuns({"--help"});
   QCOMPARE(help.exit, 0);
   QVERIFY(help.out.contains("Exit codes:"));
   QVERIFY(help.err.isEmpty());
   const Outcome version = diatomRuns({"--version"});
   QCOMPARE(version.exit, 0);
   QVERIFY(version.out.startsWith("0."));
}

void CommandsTest::everyCommandHasHelp()
{
   for (const char *command : {"info", "plugins", "lattices", "parts", "machines", "solvers", "convert",
                               "export", "plan", "simulate", "circuit", "effects", "check", "render",
                               "pipeline", "do", "commands", "replay", "bench"})
   {
      const Outcome help = diatomRuns({command, "--help"});
      QVERIFY2(help.exit == 0 && help.out.contains("Usage"), command);
   }
}

void CommandsTest::misuseExitsWithTwo()
{
   QCOMPARE(diatomRuns({}).exit, 2);
   QCOMPARE(diatomRuns({"dance"}).exit, 2);
   QCOMPARE(diatomRuns({"info"}).exit, 2);
   QCOMPARE(diatomRuns({"simulate", sample("gripper.diatom")}).exit, 2); // until when?
   for (const char *never : {"nan", "inf", "-1", "0"}) {
      const Outcome refused = diatomRuns({"simulate", sample("gripper.diatom"), "--until", never});
      QCOMPARE(refused.exit, 2);
      QVERIFY2(refused.err.contains("is not a number above 0"), refused.err.constData());
   }
   QCOMPARE(diatomRuns({"export", sample("gripper.diatom"), file("x.docx")}).exit, 2);
   const Outcome unknown = diatomRuns({"study", "accuracy", "--sample", "sagg", "-o", file("x")});
   QCOMPARE(unknown.exit, 2);
   QVERIFY2(unknown.err.contains("\"sagg\"") && unknown.err.contains("stiff-flexure"),
            unknown.err.constData());
}

void CommandsTest::unreadableInputExitsWithThree()
{
   const Outcome missing = diatomRuns({"info", file("absent.diatom")});
   QCOMPARE(missing.exit, 3);
   QVERIFY(missing.out.isEmpty());
   QVERIFY(missing.err.contains("absent.diatom"));
   QCOMPARE(diatomRuns({"info", "-"}, "{ this is no design").exit, 3);
}

void CommandsTest::aPlaceThatCannotBeWrittenExitsWithFour()
{
   const Outcome refused = diatomRuns({"export", sample("gripper.diatom"), file("no/folder/x.stl")});
   QCOMPARE(refused.exit, 4);
   QVERIFY(refused.err.contains("x.stl"));
}

void CommandsTest::aMeshBecomesCells()
{
   const QString cube = file("cube.stl"), design = file("cube.diatom");
   QCOMPARE(
       diatomRuns(
           {"export", "-", cube},
           R"({"diatom":1,"lattice":{"id":"org.diatom_cad.lattice.cube","pitch_m":0.001},)"
           R"("materials":[{"id":"a"}],"assembly":{"cells":[{"at":[0,0,0],"size":[8,8,8],"material":"a"}]}})")
           .exit,
       0);
   if (!canReadMeshes())
      QSKIP("this build has no assimp and reads no meshes");
   const Outcome asDesign = diatomRuns({"info", cube});
   QCOMPARE(asDesign.exit, 3);
   QVERIFY2(asDesign.err.contains("diatom convert"), asDesign.err.constData());
   const Outcome noPitch = diatomRuns({"convert", cube, design});
   QCOMPARE(noPitch.exit, 2);
   QVERIFY(noPitch.err.contains("--pitch"));
   const Outcome filled = diatomRuns({"convert", cube, design, "--lattice", "kelvin_body_centred", "--pitch",
                                      "0.5 mm", "--rule", "touch", "--material", "foam"});
   QVERIFY2(filled.exit == 0, filled.err.constData());
   const QJsonObject info = diatomRuns({"info", design, "--json"}).object();
   QCOMPARE(info["lattice"].toString(), QString("org.diatom_cad.lattice.kelvin_body_centred"));
   // Cells of 8 sqrt(2) units^3 fill space. By touch they hold the block of 8 mm, and all of their centres
   // lie within a cell's radius, sqrt(2.5) units, of it: within 9.6 mm along each axis, which holds 1.72 as
   // much.
   const double least = 512 / (8 * std::numbers::sqrt2 * 0.125), foam = info["materials"]["foam"].toDouble();
   QVERIFY(foam > least && foam < 1.72 * least);
   QCOMPARE(diatomRuns({"convert", cube, design, "--pitch", "-1mm"}).exit, 2);
   QCOMPARE(diatomRuns({"convert", file("absent.stl"), design, "--pitch", "1mm"}).exit, 3);
   QCOMPARE(diatomRuns({"convert", cube, design, "--pitch", "1mm", "--inside", "x.stl"}).exit, 2);
}

void CommandsTest::turnsTheLatticeDoesNotHaveAreRefused()
{
   const auto turnedCell = [](const char *orientation) {
      return QByteArray(
                 R"({"diatom":1,"lattice":{"id":"org.diatom_cad.lattice.cube","pitch_m":0.001},"materials":[{"id":"a"}],)"
                 R"("assembly":{"cells":[{"at":[0,0,0],"size":[1,1,1],"material":"a","orientation":)") +
             orientation + "}]}}";
   };
   const auto turnedComposite = [](const char *rotation) {
      return QByteArray(
                 R"({"diatom":1,"lattice":{"id":"org.diatom_cad.lattice.cube","pitch_m":0.001},"materials":[{"id":"a"}],)"
                 R"("definitions":[{"id":"d","cells":[["a",[0,0,0]]]}],"assembly":{"instances":[["d",[0,0,0],)") +
             rotation + "]]}}";
   };
   for (const QByteArray &fits : {turnedCell("23"), turnedComposite("23")}) {
      const Outcome read = diatomRuns({"info", "-"}, fits);
      QVERIFY2(read.exit == 0, read.err.constData());
   }
   for (const QByteArray &bad : {turnedCell("24"), turnedComposite("24")})
      for (const QStringList &command :
           {QStringList{"info", "-"}, QStringList{"simulate", "-", "--until", "0.001"},
            QStringList{"check", "-"}, QStringList{"render", "-", file("x.png")}})
      {
         const Outcome refused = diatomRuns(command, bad);
         QCOMPARE(refused.exit, 1);
         QVERIFY2(refused.err.contains("0 to 23"), refused.err.constData());
      }
}

void CommandsTest::aMissingLatticeIsToldAndTheDesignKept()
{
   const QByteArray text = R"({"diatom": 1, "name": "kept", "lattice": {"id": "org.nobody.lattice.quasi"},
      "materials": [{"id": "a"}], "assembly": {"cells": [["a", [0, 0, 0], [3, 2, 1]]]}})";
   const auto info = diatomRuns({"info", "-", "--json"}, text);
   QVERIFY2(info.exit == 0, info.err.constData());
   QVERIFY2(info.err.contains("org.nobody.lattice.quasi is not installed"), info.err.constData());
   QCOMPARE(info.object()["stored_cells"].toInt(), 6);
   QCOMPARE(info.object()["lattice_installed"], QJsonValue(false));
   const QString once = file("once.diatom"), twice = file("twice.diatom");
   QCOMPARE(diatomRuns({"convert", "-", once}, text).exit, 0);
   QCOMPARE(diatomRuns({"convert", once, twice}).exit, 0);
   const auto hash = [&](const QString &of) {
      return diatomRuns({"info", of, "--json"}).object()["hash"].toString();
   };
   QCOMPARE(hash(once), info.object()["hash"].toString());
   QCOMPARE(hash(twice), info.object()["hash"].toString());
   // What needs the places of cells says what is missing.
   const auto exported = diatomRuns({"export", once, file("none.stl")});
   QVERIFY(exported.exit != 0);
   QVERIFY2(exported.err.contains("org.nobody.lattice.quasi"), exported.err.constData());
}

void CommandsTest::infoPrintsTheAgreedKeys()
{
   const Outcome info = diatomRuns({"info", sample("capacitor-tower.diatom"), "--json"});
   QCOMPARE(info.exit, 0);
   const QJsonObject object = info.object();
   for (const char *key : {"lattice", "pitch_m", "cells", "stored_cells", "composites", "depth", "bounds",
                           "materials", "mass_kg"})
      QVERIFY2(object.contains(key), key);
   QVERIFY(object["depth"].toInt() > 1);
   double sum = 0;
   for (const QJsonValue count : object["materials"].toObject())
      sum += count.toDouble();
   QCOMPARE(sum, object["cells"].toDouble());
}

void CommandsTest::standardInputIsAFileToo()
{
   const auto bytes = readFile(sample("gripper.diatom").toStdString());
   DIATOM_VERIFY_OK(bytes);
   const Outcome piped = diatomRuns({"info", "-", "--json"}, QByteArray::fromStdString(*bytes));
   QCOMPARE(piped.exit, 0);
   QCOMPARE(piped.object()["hash"],
            diatomRuns({"info", sample("gripper.diatom"), "--json"}).object()["hash"]);
}

void CommandsTest::simulateReportsAndRecords()
{
   const Outcome run = diatomRuns({"simulate", sample("bending-beam.diatom"), "--until", "0.01", "--probe",
                                   "13,0,0:z", "--record", file("out.csv"), "--json"});
   QCOMPARE(run.exit, 0);
   const QJsonObject object = run.object();
   for (const char *key : {"status", "steps", "step_s", "stable_step_s", "wall_s", "ns_per_cell_step",
                           "effects", "energy", "momentum", "probes"})
      QVERIFY2(object.contains(key), key);
   QVERIFY(object["probes"].toObject()["13,0,0:z"].toDouble() < 0); // it falls
   const auto record = readFile(file("out.csv").toStdString());
   DIATOM_VERIFY_OK(record);
   QVERIFY(record->find("13,0,0:z") != std::string::npos);
   // The same bits on one thread.
   const Outcome alone = diatomRuns({"simulate", sample("bending-beam.diatom"), "--until", "0.01", "--probe",
                                     "13,0,0:z", "--record", file("one.csv"), "--threads", "1", "--json"});
   QCOMPARE(*readFile(file("one.csv").toStdString()), *record);
   QCOMPARE(alone.object()["probes"], object["probes"]);
   QCOMPARE(alone.object()["energy"], object["energy"]);
}

void CommandsTest::aStepThatCannotBeStableIsRefused()
{
   const Outcome refused =
       diatomRuns({"simulate", sample("bending-beam.diatom"), "--until", "0.01", "--step", "0.01"});
   QCOMPARE(refused.exit, 1); // refused before it starts: 6 is for a run that diverged
   QVERIFY2(refused.err.contains("longer than the stable limit"), refused.err.constData());
}

void CommandsTest::exportWritesOneFilePerMaterial()
{
   QCOMPARE(diatomRuns({"export", sample("gripper.diatom"), file("g.stl"), "--each-material"}).exit, 0);
   QVERIFY(fs::exists(file("g.structural.stl").toStdString()));
   QVERIFY(fs::exists(file("g.actuator.stl").toStdString()));
   QVERIFY(!fs::exists(file("g.stl").toStdString()));
   QCOMPARE(diatomRuns({"export", sample("capacitor-tower.diatom"), file("b.stl"), "--as", "parts"}).exit, 0);
   QVERIFY(fs::file_size(file("b.stl").toStdString()) > 84);
}

void CommandsTest::planWritesAProgram()
{
   const Outcome plan = diatomRuns({"plan", sample("capacitor-tower.diatom"), "--machine",
                                    "org.diatom_cad.machine.gcode", "-o", file("t.ngc"), "--json"});
   QCOMPARE(plan.exit, 0);
   QVERIFY(plan.object()["placements"].toInt() > 0);
   QVERIFY(plan.object()["path_m"].toDouble() > 0);
   const auto program = readFile(file("t.ngc").toStdString());
   DIATOM_VERIFY_OK(program);
   QVERIFY(program->ends_with("M2\n"));
}

void CommandsTest::renderWritesAPicture()
{
   const Outcome drawn =
       diatomRuns({"render", sample("octahedral-truss.diatom"), file("p.png"), "--size", "160x100"});
   QCOMPARE(drawn.exit, 0);
   const auto png = readFile(file("p.png").toStdString());
   DIATOM_VERIFY_OK(png);
   QVERIFY(png->starts_with("\x89PNG"));
   QVERIFY(png->size() > 1000); // more than one colour
}

// As many triangles as an export writes, another picture than that of cells, and one sentence where there is
// nothing to draw.
void CommandsTest::renderDrawsPartsAndStruts()
{
   const QString truss = sample("octahedral-truss.diatom");
   const auto draw = [&](const QStringList &more) {
      return diatomRuns(QStringList{"render", truss, file("d.png"), "--size", "160x100", "--json"} + more);
   };
   const auto picture = [&] { return *readFile(file("d.png").toStdString()); };
   QCOMPARE(draw({}).exit, 0);
   const std::string cells = picture();
   const Outcome parts = draw({"--as", "parts"});
   QVERIFY2(parts.exit == 0, parts.err.constData());
   const std::string ofParts = picture();
   const Outcome struts = draw({"--as", "struts"});
   QVERIFY2(struts.exit == 0, struts.err.constData());
   QVERIFY(cells != ofParts && ofParts != picture() && picture() != cells);
   for (const auto &[what, drawn] : {std::pair{"parts", parts}, std::pair{"struts", struts}}) {
      const Outcome written = diatomRuns({"export", truss, file("d.obj"), "--as", QString(what), "--json"});
      QCOMPARE(written.exit, 0);
      QCOMPARE(drawn.object()["triangles"], written.object()["files"].toArray()[0].toObject()["triangles"]);
   }
   QCOMPARE(draw({"--as", "parts", "--parts", "snap_voxel"}).exit, 0);
   QVERIFY(picture() == ofParts);

   const Outcome unknown = draw({"--as", "parts", "--parts", "gik"});
   QVERIFY(unknown.exit != 0);
   QVERIFY2(unknown.err.contains("makes no parts for the lattice"), unknown.err.constData());
   QCOMPARE(unknown.err.count('\n'), 1);
   for (const QStringList &wrong :
        {QStringList{"--as", "parts", "--at-time", "1"}, QStringList{"--as", "struts", "--parts", "gik"},
         QStringList{"--detail", "0"}, QStringList{"--as", "bricks"}})
      QCOMPARE(draw(wrong).exit, 2);
}

void CommandsTest::convertKeepsTheDesign()
{
   QCOMPARE(diatomRuns({"convert", sample("walker.diatom"), file("w.diatom")}).exit, 0);
   QCOMPARE(diatomRuns({"info", file("w.diatom"), "--json"}).object()["hash"],
            diatomRuns({"info", sample("walker.diatom"), "--json"}).object()["hash"]);
}

void CommandsTest::doAndReplayMakeTheSameDesign()
{
   const QByteArray log = R"({"command":"set-material","arguments":{"id":"a"}}
{"command":"fill","arguments":{"box":[[0,0,0],[2,2,2]],"material":"a"}}
)";
   DIATOM_VERIFY_OK(writeFileAtomic(file("log").toStdString(), log.toStdString()));
   QCOMPARE(diatomRuns({"replay", "new", file("log"), "-o", file("a.diatom")}).exit, 0);
   QCOMPARE(
       diatomRuns({"do", file("a.diatom"), "place", "cell=0,0,5", "material=a", "-o", file("b.diatom")}).exit,
       0);
   QCOMPARE(diatomRuns({"info", file("b.diatom"), "--json"}).object()["cells"].toInt(), 28);
   const Outcome taken =
       diatomRuns({"do", file("b.diatom"), "place", "cell=0,0,5", "material=a", "-o", file("c.diatom")});
   QCOMPARE(taken.exit, 1);
   QVERIFY(taken.err.contains("taken"));
   QVERIFY(!fs::exists(file("c.diatom").toStdString()));
}

void CommandsTest::checkFindsAConflictAndExitsWithFive()
{
   QCOMPARE(diatomRuns({"check", sample("gripper.diatom")}).exit, 0);
   // Two sources side by side drive one net.
   const QByteArray log = R"({"command":"set-material","arguments":{"id":"s","role":"source"}}
{"command":"fill","arguments":{"box":[[0,0,0],[1,0,0]],"material":"s"}}
{"command":"source","arguments":{"cell":[0,0,0]}}
{"command":"source","arguments":{"cell":[1,0,0]}}
)";
   DIATOM_VERIFY_OK(writeFileAtomic(file("log").toStdString(), log.toStdString()));
   QCOMPARE(diatomRuns({"replay", "new", file("log"), "-o", file("s.diatom")}).exit, 0);
   const Outcome found = diatomRuns({"check", file("s.diatom")});
   QCOMPARE(found.exit, 5);
   QVERIFY2(found.out.contains("two-sources"), found.out.constData());
}

void CommandsTest::pipelineDoesTheMainJob()
{
   const Outcome done =
       diatomRuns({"pipeline", sample("gripper.diatom"), "-o", file("out"), "--until", "0.02", "--json"});
   QVERIFY2(done.exit == 0, done.err.constData());
   const QJsonObject report = done.object();
   QVERIFY(report["design"].toObject()["cells"].toInt() > 0);
   QVERIFY(report["simulation"].toObject()["simulated_s"].toDouble() >= 0.02);
   QVERIFY(report["assembly"].toObject()["placements"].toInt() > 0);
   for (const char *stage : {"assembly", "picture"})
      QVERIFY(fs::exists(report[stage].toObject()["file"].toString().toStdString()));
   for (const QJsonValue stl : report["stl"].toObject()["files"].toArray())
      QVERIFY(fs::exists(stl.toObject()["file"].toString().toStdString()));
}

void CommandsTest::everyPluginOfOursIsAccepted()
{
   const QJsonArray plugins = diatomRuns({"plugins", "--json"}).json().array();
   QVERIFY(plugins.size() >= 10);
   for (const QJsonValue plugin : plugins)
      QCOMPARE(plugin.toObject()["verdict"].toString(), QString("ok"));
}

QTEST_APPLESS_MAIN(CommandsTest)
#include "commands_test.moc"
