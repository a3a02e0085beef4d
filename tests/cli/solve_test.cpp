// diatom solve, modes and effects, and what simulate is told, as a user calls them. The solver is one that
// stands in (tests/abi/stand_ins), so that every figure is known; the real one has tests of its own.
#include "cli/program.h"
#include "core/file.h"

#include <cmath>
#include <cstring>

using namespace diatom;
using test::diatomRuns;
using Outcome = test::Printed;

namespace {

QStringList standIns()
{
   return {"--plugins",
           QString::fromStdString((test::binaryDir() / "tests" / "plugins" / "stand_ins").string())};
}

/// Four cells along x, 1 mm apart; the first held, the last driven along x and loaded along z.
constexpr const char *kRow = R"({
  "diatom": 1, "lattice": {"id": "org.diatom_cad.lattice.cube"}, "materials": [{"id": "a"}],
  "assembly": {"cells": [["a", [0, 0, 0], [4, 1, 1]]]},
  "simulation": {
    "supports": [{"cell": [0, 0, 0]}],
    "drives": [{"cell": [3, 0, 0], "freedom": "x", "curve_s_m": [[0, 0], [0.5, 0.0005]]}],
    "loads": [{"cell": [3, 0, 0], "force_N": [0, 0, -4]}],
    "solver": {"id": "test.balance"}
  }
})";

Outcome solve(QStringList arguments, const QByteArray &design = kRow)
{
   return diatomRuns(QStringList{"solve", "-", "--json"} + standIns() + arguments, design);
}

double number(const QJsonObject &object, const char *group, const char *key)
{
   return object[group].toObject()[key].toDouble(-1);
}

QJsonArray array(std::initializer_list<double> values)
{
   QJsonArray list;
   for (const double value : values)
      list.append(value);
   return list;
}

QByteArray replaced(QByteArray text, const char *before, const char *after)
{
   if (!text.contains(before))
      qFatal("no %s", before);
   return text.replace(before, after);
}

} // namespace

class SolveTest : public QObject
{
   Q_OBJECT
private slots:
   void init() { m_dir = std::make_unique<QTemporaryDir>(); }
   void solvePrintsBalanceDisplacementAndReactions();
   void solveRecordsTheWayThere();
   void solveWritesTheDeformedSurface();
   void aBodyThatCanMoveIsRefusedBeforeTheSolverIsAsked();
   void aBodyThatCanTurnIsWarnedAbout();
   void aBalanceThatIsNotFoundExitsWithSix();
   void theSolverOfOursBalancesACantilever();
   void modesPrintsFrequenciesAndKinds();
   void theSolverOfOursFindsAChainsModes();
   void modesWritesShapes();
   void aSolverSaysWhatItCannotDo();
   void optionsReachTheSolver_data();
   void optionsReachTheSolver();
   void effectsNamesEntriesAndCells();
   void effectsTellWhatTheyCost();
   void checkWarnsOfFreeBodies();

private:
   QString file(const char *name) const { return m_dir->filePath(name); }
   std::unique_ptr<QTemporaryDir> m_dir;
};

void SolveTest::solvePrintsBalanceDisplacementAndReactions()
{
   const Outcome run = solve({"--probe", "3,0,0:x", "--probe", "0,0,0:fz", "--load-steps", "3"});
   QVERIFY2(run.exit == 0, run.err.constData());
   const QJsonObject object = run.object();
   QCOMPARE(object["status"].toString(), QString("done"));
   QCOMPARE(object["time_s"].toDouble(), 0.5); // the end of the longest curve
   QCOMPARE(object["residual"].toDouble(), 1e-10);
   QCOMPARE(object["iterations"].toInt(), 3);
   // 1 mm for each second; the position of 1e-3 is taken away from 1e-3 + 5e-4, hence the rounding.
   QVERIFY(std::abs(number(object, "largest_displacement", "m") - 5e-4) < 1e-15);
   QVERIFY(std::abs(number(object, "probes", "3,0,0:x") - 5e-4) < 1e-15);
   QCOMPARE(number(object, "probes", "0,0,0:fz"), 4.0);
   const QJsonObject reactions = object["reactions"].toObject();
   QCOMPARE(reactions["loads"].toObject()["force_N"].toArray(), array({0, 0, -4}));
   QCOMPARE(reactions["total"].toObject()["force_N"].toArray(), array({0, 0, 4}));
   QCOMPARE(reactions["unbalanced_N"].toDouble(-1), 0.0);
   QCOMPARE(reactions["supports"].toArray()[0].toObject()["on"].toString(), QString("cell (0, 0, 0)"));
   QCOMPARE(reactions["drives"].toArray()[0].toObject()["freedom"].toString(), QString("x"));
   QCOMPARE(solve({"--at", "0.2"}).object()["time_s"].toDouble(), 0.2);
}

void SolveTest::solveRecordsTheWayThere()
{
   const QString record = file("pull.csv"), state = file("state.csv");
   const Outcome run = solve({"--every", "0.2", "--record", record, "--state", state, "--probe", "3,0,0:x"});
   QVERIFY2(run.exit == 0, run.err.constData());
   const auto text = readFile(record.toStdString());
   DIATOM_VERIFY_OK(text);
   const QStringList lines = QString::fromStdString(*text).split('\n', Qt::SkipEmptyParts);
   QCOMPARE(lines[0], QString("time (s),\"3,0,0:x (m)\",residual,driven fx (N),driven fy (N),driven fz (N),"
                              "driven mx (N m),driven my (N m),driven mz (N m)"));
   QCOMPARE(lines.size(), 5); // 0, 0.2, 0.4 and 0.5 s
   QVERIFY(lines[4].startsWith("0.5,"));
   const auto cells = readFile(state.toStdString());
   DIATOM_VERIFY_OK(cells);
   QVERIFY2(cells->starts_with("i,j,k,material,x (m),y (m),z (m),qw,qx,qy,qz,fx (N),fy (N),fz (N),mx (N m)"),
            cells->c_str());
   QVERIFY(solve({"--every", "1e-9"}).err.contains("--every is too short"));
}

void SolveTest::solveWritesTheDeformedSurface()
{
   // Every cell moves by 0.5 mm, so that the surface is that of the rest, moved; scaled by 4 that is 2 mm.
   const auto highest = [&](const QStringList &options) {
      const QString stl = file("bent.stl");
      const Outcome run = solve(QStringList{"--stl", stl} + options);
      if (run.exit != 0)
         qFatal("%s", run.err.constData());
      const auto bytes = readFile(stl.toStdString());
      const std::size_t triangles = (bytes->size() - 84) / 50;
      float most = -1e9F;
      for (std::size_t t = 0; t < triangles; ++t)
         for (std::size_t corner = 0; corner < 3; ++corner) {
            float x = 0;
            std::memcpy(&x, bytes->data() + 84 + 50 * t + 12 + 12 * corner, sizeof x);
            most = std::max(most, x);
         }
      return std::pair(triangles, most);
   };
   // A bar of four cubes has 18 faces of two triangles; it ends half a cell beyond x = 3 mm.
   QCOMPARE(highest({}).first, std::size_t{36});
   QVERIFY(std::abs(highest({}).second - 4.0F) < 1e-6F); // rounding of single precision
   QVERIFY(std::abs(highest({"--scale", "4"}).second - 5.5F) < 1e-6F);
}

void SolveTest::aBodyThatCanMoveIsRefusedBeforeTheSolverIsAsked()
{
   const Outcome slides =
       solve({}, replaced(kRow, R"([{"cell": [0, 0, 0]}])",
                          R"([{"cell": [0, 0, 0], "fixed": ["x", "z", "rx", "ry", "rz"]}])"));
   QCOMPARE(slides.exit, 1);
   QVERIFY2(slides.err.contains("no static balance: the body of 4 cells at (0, 0, 0) can move along y"),
            slides.err.constData());
   const Outcome falls =
       solve({"--set", "gravity.z=-9.8"},
             replaced(replaced(kRow, R"("supports": [{"cell": [0, 0, 0]}],)", ""),
                      R"("freedom": "x", "curve_s_m")", R"("freedom": "rx", "curve_s_rad")"));
   QCOMPARE(falls.exit, 1);
   QVERIFY2(falls.err.contains("it will fall for ever"), falls.err.constData());
}

void SolveTest::aBodyThatCanTurnIsWarnedAbout()
{
   const Outcome turns = solve(
       {}, replaced(kRow, R"([{"cell": [0, 0, 0]}])", R"([{"cell": [0, 0, 0], "fixed": ["x", "y", "z"]}])"));
   QCOMPARE(turns.exit, 0);
   QVERIFY2(turns.err.contains("warning: ") && turns.err.contains("can turn about x and y and z"),
            turns.err.constData());
}

void SolveTest::aBalanceThatIsNotFoundExitsWithSix()
{
   const Outcome run = solve({"--set", "solver.end=diverges"});
   QCOMPARE(run.exit, 6);
   QVERIFY(run.out.isEmpty());
   QVERIFY2(run.err.contains("a static balance was not found") && run.err.contains("at cell (1, 0, 0)"),
            run.err.constData());
}

void SolveTest::theSolverOfOursBalancesACantilever()
{
   // The stiff 1x1 cantilever of BeamBending: 14 cells along y, E = 0.5 MPa, 3500 kg/m3, root clamped.
   constexpr const char *kCantilever = R"({
     "diatom": 1, "lattice": {"id": "org.diatom_cad.lattice.cube"},
     "materials": [{"id": "a", "density_kg_m3": 3500, "youngs_modulus_Pa": 5e5, "poisson_ratio": 0.3}],
     "assembly": {"cells": [["a", [0, 0, 0], [1, 14, 1]]]},
     "simulation": {"gravity_m_s2": [0, 0, -9.8], "supports": [{"cell": [0, 0, 0]}]}
   })";
   const Outcome run = diatomRuns(
       {"solve", "-", "--json", "--probe", "0,13,0:y", "--probe", "0,13,0:z", "--probe", "0,13,0:rx"},
       kCantilever);
   QVERIFY2(run.exit == 0, run.err.constData());
   const QJsonObject object = run.object();
   // The balance by large rotations is (-0.43, -3.11) mm and -18.6 degrees at the tip (amoeba.md 2.4), given
   // to two decimals.
   QVERIFY(std::abs(1e3 * number(object, "probes", "0,13,0:y") + 0.43) < 0.006);
   QVERIFY(std::abs(1e3 * number(object, "probes", "0,13,0:z") + 3.11) < 0.006);
   QVERIFY(std::abs(number(object, "probes", "0,13,0:rx") * 180 / M_PI + 18.6) < 0.06);
   // The root supplies the weight of 14 cells but for the residual of 1e-8 of the largest force.
   const QJsonObject reactions = object["reactions"].toObject();
   const double weight = 14 * 3500e-9 * 9.8;
   QVERIFY(std::abs(reactions["total"].toObject()["force_N"].toArray()[2].toDouble() - weight) <
           1e-7 * weight);
   QVERIFY(reactions["unbalanced_N"].toDouble() < 1e-7 * weight);
}

void SolveTest::modesPrintsFrequenciesAndKinds()
{
   const Outcome run = diatomRuns(QStringList{"modes", "-", "--json", "-n", "4"} + standIns(), kRow);
   QVERIFY2(run.exit == 0, run.err.constData());
   const QJsonObject object = run.object();
   QCOMPARE(object["hertz"].toArray().size(), 1);
   QVERIFY(std::abs(object["hertz"].toArray()[0].toDouble() - 3) < 1e-12); // the stand-in gives 17 digits
   const QJsonArray modes = object["modes"].toArray();
   QCOMPARE(modes.size(), 4);
   QCOMPARE(modes[0].toObject()["kind"].toString(), QString("unstable"));
   QCOMPARE(modes[1].toObject()["kind"].toString(), QString("neutral"));
   QVERIFY2(run.err.contains("the balance is unstable"), run.err.constData());
}

void SolveTest::theSolverOfOursFindsAChainsModes()
{
   constexpr const char *kBar = R"({
     "diatom": 1, "lattice": {"id": "org.diatom_cad.lattice.cube"},
     "materials": [{"id": "a", "density_kg_m3": 1000, "youngs_modulus_Pa": 1e6, "poisson_ratio": 0.3}],
     "assembly": {"cells": [["a", [0, 0, 0], [5, 1, 1]]]},
     "simulation": {"supports": [{"cell": [0, 0, 0]}]}
   })";
   const Outcome run = diatomRuns({"modes", "-", "--json", "-n", "14"}, kBar);
   QVERIFY2(run.exit == 0, run.err.constData());
   const QJsonArray hertz = run.object()["hertz"].toArray();
   QCOMPARE(hertz.size(), 14);
   // Along its axis the bar is a chain of 4 masses, held at one end: 2 sqrt(k / m) sin((2 j - 1) pi / 18)
   // with k = E l = 1000 N/m and m = 1 mg. The file's numbers and the solver's are good to 1e-10.
   for (int j = 1; j <= 2; ++j) {
      const double exact = std::sqrt(1000 / 1e-6) * std::sin((2 * j - 1) * M_PI / 18) / M_PI;
      double nearest = 0;
      for (const QJsonValue &one : hertz)
         if (std::abs(one.toDouble() - exact) < std::abs(nearest - exact))
            nearest = one.toDouble();
      QVERIFY2(std::abs(nearest / exact - 1) < 1e-9, qPrintable(QString::number(nearest / exact - 1)));
   }
   // A square bar bends alike both ways.
   QVERIFY(std::abs(hertz[1].toDouble() / hertz[0].toDouble() - 1) < 1e-9);
}

void SolveTest::modesWritesShapes()
{
   const QString shapes = file("shapes.csv");
   const Outcome run =
       diatomRuns(QStringList{"modes", "-", "-n", "2", "--shapes", shapes} + standIns(), kRow);
   QVERIFY2(run.exit == 0, run.err.constData());
   const auto text = readFile(shapes.toStdString());
   DIATOM_VERIFY_OK(text);
   const QStringList lines = QString::fromStdString(*text).split('\n', Qt::SkipEmptyParts);
   QCOMPARE(lines.size(), 1 + 2 * 4);
   QCOMPARE(lines[0], QString("mode,frequency (Hz),i,j,k,x (m),y (m),z (m),rx (rad),ry (rad),rz (rad)"));
   QCOMPARE(lines[8], QString("2,0,3,0,0,130,131,132,133,134,135"));
}

void SolveTest::aSolverSaysWhatItCannotDo()
{
   const Outcome run = diatomRuns(QStringList{"simulate", "-", "--until", "1"} + standIns(), kRow);
   QCOMPARE(run.exit, 1);
   QVERIFY2(run.err.contains("test.balance cannot simulate motion in time; choose another solver"),
            run.err.constData());
}

void SolveTest::optionsReachTheSolver_data()
{
   QTest::addColumn<QStringList>("options");
   QTest::addColumn<QByteArray>("says");
   // A solver without the parameter refuses it by name, which shows that it was handed over.
   QTest::newRow("beam") << QStringList{"--beam", "euler"} << QByteArray("beam");
   QTest::newRow("gradient") << QStringList{"--gradient", "exact"} << QByteArray("gradient");
}

void SolveTest::optionsReachTheSolver()
{
   QFETCH(QStringList, options);
   QFETCH(QByteArray, says);
   const Outcome run = solve(options);
   QCOMPARE(run.exit, 1);
   QVERIFY2(run.err.contains("no parameter named \"" + says + "\""), run.err.constData());
}

void SolveTest::effectsNamesEntriesAndCells()
{
   const Outcome run = diatomRuns({"effects", "-", "--json"}, kRow);
   QVERIFY2(run.exit == 0, run.err.constData());
   QStringList on;
   for (const auto &row : run.json().array())
      if (row.toObject()["on"].toBool())
         on += row.toObject()["name"].toString() + ": " + row.toObject()["why"].toString();
   QVERIFY2(on.contains("driven: one curve drives a freedom on cell (3, 0, 0)"), run.out.constData());
   QVERIFY2(on.contains("loads: one load acts on cell (3, 0, 0)"), run.out.constData());
   QCOMPARE(on.size(), 3); // and rotation
}

/// The bond solver moves this row: what the loads add is measured, and what is off adds nothing.
void SolveTest::effectsTellWhatTheyCost()
{
   const QByteArray bonds =
       replaced(replaced(kRow, R"("test.balance")", R"("org.diatom_cad.solver.bonds")"), R"({"id": "a"})",
                R"({"id": "a", "density_kg_m3": 1000, "youngs_modulus_Pa": 1e9, "poisson_ratio": 0.3})");
   const auto costs = [&](const QStringList &options) {
      const Outcome run = diatomRuns(QStringList{"effects", "-", "--json"} + options, bonds);
      QTest::qVerify(run.exit == 0, "effects", run.err.constData(), __FILE__, __LINE__);
      QMap<QString, QJsonValue> found;
      for (const auto &row : run.json().array())
         found[row.toObject()["name"].toString()] = row.toObject()["cost_ns"];
      return found;
   };
   const auto measured = costs({}), none = costs({"--no-cost"});
   QVERIFY(measured["loads"].isDouble());
   QVERIFY(measured["loads"].toDouble() >= 0);
   QCOMPARE(measured["gravity"].toDouble(-1), 0.0);
   for (const QJsonValue &cost : none)
      QVERIFY(cost.isNull());
}

void SolveTest::checkWarnsOfFreeBodies()
{
   const Outcome run =
       diatomRuns({"check", "-", "--json"},
                  replaced(kRow, R"([{"cell": [0, 0, 0]}])", R"([{"cell": [0, 0, 0], "fixed": ["rx"]}])"));
   QVERIFY2(run.out.contains("not-held"), run.out.constData());
   const Outcome clash =
       diatomRuns({"check", "-", "--json"}, replaced(kRow, R"({"cell": [0, 0, 0]})", R"({"material": "a"})"));
   QCOMPARE(clash.exit, 5);
   QVERIFY2(clash.out.contains("held-and-driven"), clash.out.constData());
}

QTEST_APPLESS_MAIN(SolveTest)
#include "solve_test.moc"
