// The vector kernel beside the one that takes a bond at a time: the same motion to rounding, whatever the
// scene calls for, and the same bits for any number of threads and, where asked, any instruction set.
#include "solver_bonds_scene.h"

#include <cstring>
#include <random>

using namespace diatom::test;

namespace {

using Props = std::map<std::string, double>;

Props rubber(double modulus, double damping = 0)
{
   return {
       {"density", 3500}, {"youngs_modulus", modulus}, {"poisson_ratio", 0.3}, {"damping_ratio", damping}};
}

/// A block with sides that no vector divides, and holes in it where `filled` is below 1.
HandScene blockOf(int nx, int ny, int nz, double damping, int materials = 1, double filled = 1)
{
   HandScene scene(1e-3);
   for (int m = 0; m < materials; ++m)
      scene.addMaterial(rubber(5e5 * (1 + m), damping));
   std::mt19937_64 random(3);
   std::uniform_real_distribution<double> unit(0, 1);
   for (int x = 0; x < nx; ++x)
      for (int y = 0; y < ny; ++y)
         for (int z = 0; z < nz; ++z)
            if (filled >= 1 || unit(random) < filled)
               scene.addCell(x, y, z, static_cast<int>(unit(random) * materials));
   scene.link();
   if (damping > 0)
      scene.effects.push_back("damping");
   return scene;
}

void addEverything(HandScene &scene)
{
   for (const char *effect : {"gravity", "drag", "actuation", "loads", "ground", "friction"})
      scene.effects.push_back(effect);
   scene.addRow("gravity", {1, 0, -9.8});
   scene.addRow("drag", {20});
   scene.addRow("source", {0, 1000, 0, 0.5, 0, 1}, 0);
   for (const int mode : {0, 1, 2, 3})
      scene.addRow("actuator", {double(mode), double(mode % 3), 0.2, 0, -1}, 7 + 5 * mode);
   scene.addRow("force", {2e-4, 0, 1e-4, 0, 0, 1e-8}, 5);
   scene.addRow("ground", {-0.45e-3, 1000, 0.05, 0.4}); // the lowest layer has sunk in
   scene.addRow("driven", {1, 0}, scene.cells() - 1);
   scene.addRow("driven", {5, 1}, scene.cells() - 1);
   scene.addRow("curve", {0, 0}, 0);
   scene.addRow("curve", {1e-3, 2e-4}, 0);
   scene.addRow("curve", {0, 0}, 1);
   scene.addRow("curve", {1e-3, 0.3}, 1);
   scene.fix(0);
   scene.fix(1, 0b000101);
}

/// Cells of a face-centred lattice: bonds of six directions, none along an axis.
HandScene askew(int n, double damping)
{
   HandScene scene(1e-3);
   scene.addMaterial(rubber(5e5, damping));
   scene.addMaterial(rubber(2e6, damping));
   for (int x = 0; x < n; ++x)
      for (int y = 0; y < n; ++y)
         for (int z = 0; z < n; ++z)
            if ((x + y + z) % 2 == 0)
               scene.addCell(x, y, z, (x + 2 * y) % 3 == 0);
   for (const auto &[at, cell] : scene.at)
      for (const auto &[dx, dy, dz] : {std::array{1, 1, 0}, std::array{1, -1, 0}, std::array{1, 0, 1},
                                       std::array{1, 0, -1}, std::array{0, 1, 1}, std::array{0, 1, -1}})
         if (const auto found = scene.at.find({at[0] + dx, at[1] + dy, at[2] + dz}); found != scene.at.end())
            scene.addLink(cell, found->second, -1);
   if (damping > 0)
      scene.effects.push_back("damping");
   return scene;
}

HandScene sceneOf(const QString &kind)
{
   if (kind == "dense")
      return blockOf(9, 7, 11, 0);
   if (kind == "damped")
      return blockOf(9, 7, 11, 0.2);
   if (kind == "unlike materials")
      return blockOf(9, 7, 11, 0.1, 5);
   if (kind == "sparse")
      return blockOf(12, 12, 12, 0.1, 3, 0.5);
   if (kind == "held floor") { // whose bonds are left out but for the one to a cell that follows a curve
      HandScene scene = blockOf(9, 7, 6, 0.1);
      for (const auto &[at, cell] : scene.at)
         if (at[2] < 2)
            scene.fix(cell);
      scene.effects.push_back("driven");
      scene.addRow("driven", {0, 0}, scene.at[{4, 3, 1}]);
      scene.addRow("curve", {0, 0}, 0);
      scene.addRow("curve", {1e-3, 1e-4}, 0);
      return scene;
   }
   if (kind == "beam")
      return blockOf(40, 1, 1, 0);
   if (kind == "actuated") { // and nothing else: no constants but those of its one material
      HandScene scene = blockOf(7, 5, 6, 0);
      scene.effects.push_back("actuation");
      scene.addRow("source", {0, 1000, 0, 0.5, 0, 1}, 0);
      for (int i = 0; i < scene.cells(); i += 3)
         scene.addRow("actuator", {double(i % 4), double(i % 3), 0.1, 0, -1}, i);
      return scene;
   }
   if (kind == "askew")
      return askew(9, 0.1);
   HandScene scene = blockOf(9, 7, 5, kind == "all but damping" ? 0 : 0.2, 3);
   addEverything(scene);
   if (kind == "flat boxes" || kind == "bricks")
      for (int i = 0; i < scene.cells(); ++i) {
         scene.extent[3 * i + 1] *= 0.5 + 0.1 * (i % 3);
         if (kind == "bricks") // no two of their inertias are alike
            scene.extent[3 * i] *= 0.8;
         scene.orientation[4 * i] = scene.orientation[4 * i + 3] = i % 2 ? std::sqrt(0.5) : 0;
         scene.orientation[4 * i] = i % 2 ? std::sqrt(0.5) : 1;
      }
   return scene;
}

std::vector<double> stateOf(Run &run)
{
   std::vector<double> all;
   for (const char *name : {"position", "rotation", "velocity", "angular_velocity"}) {
      const auto more = run.read(name);
      all.insert(all.end(), more.begin(), more.end());
   }
   return all;
}

double apart(Run &a, Run &b, const char *name)
{
   const auto x = a.read(name), y = b.read(name);
   double worst = 0, size = 1e-300;
   for (std::size_t i = 0; i < x.size(); ++i) {
      worst = std::max(worst, std::abs(x[i] - y[i]));
      size = std::max(size, std::abs(y[i]));
   }
   return worst / size;
}

} // namespace

class SolverBondsVectorTest : public QObject
{
   Q_OBJECT
private slots:
   void theMotionIsThatOfOneBondAtATime_data();
   void theMotionIsThatOfOneBondAtATime();
   void farTurnsAreExactAsWell();
   void reproducibleRunsHaveTheSameBitsOnAnyInstructions_data();
   void reproducibleRunsHaveTheSameBitsOnAnyInstructions();
   void tilesAndThreadsDoNotChangeABit_data();
   void tilesAndThreadsDoNotChangeABit();
   void singlePrecisionStaysUnstrainedFarAway();
   void whatItCannotDoIsSaid();
};

void SolverBondsVectorTest::theMotionIsThatOfOneBondAtATime_data()
{
   QTest::addColumn<QString>("kind");
   QTest::addColumn<QString>("integrator");
   QTest::addColumn<bool>("small");
   for (const char *kind : {"dense", "damped", "unlike materials", "sparse", "held floor", "beam", "askew",
                            "actuated", "everything", "all but damping", "flat boxes", "bricks"})
      for (const char *integrator : {"semi_implicit", "verlet", "rk4", "midpoint", "forward_euler"})
         for (const bool small : {false, true})
            QTest::addRow("%s, %s%s", kind, integrator, small ? ", small turns" : "")
                << QString(kind) << QString(integrator) << small;
}

/// Two hundred steps of the stable length turn the last digits over some hundred times: 1e-13 becomes 1e-11.
/// Single precision likewise from 1e-7; friction's stick and slip may part ways there and is not compared.
void SolverBondsVectorTest::theMotionIsThatOfOneBondAtATime()
{
   QFETCH(QString, kind);
   QFETCH(QString, integrator);
   QFETCH(bool, small);
   HandScene scene = sceneOf(kind);
   if (small)
      std::erase(scene.effects, "rotation");
   kickAll(scene, 0.1);
   Run slow(scene, {.integrator = integrator.toStdString(), .instructions = "scalar"});
   QVERIFY2(slow.status == DIATOM_OK, slow.host.said.c_str());
   const double step = 0.3 * slow.estimate.stable_step;
   QCOMPARE(slow.to(200 * step, step), DIATOM_OK);
   QCOMPARE(slow.result.state, DIATOM_DONE);
   for (const char *precision : {"f64", "f32"}) {
      const bool single = std::strcmp(precision, "f32") == 0;
      Run fast(scene, {.integrator = integrator.toStdString(), .precision = precision});
      QVERIFY2(fast.status == DIATOM_OK, fast.host.said.c_str());
      QCOMPARE(fast.to(200 * step, step), DIATOM_OK);
      const double bound = single ? 2e-4 : 1e-11;
      for (const char *name : {"position", "rotation", "velocity", "angular_velocity", "energy", "reaction"})
      {
         const double off = apart(fast, slow, name);
         QVERIFY2(off < bound, qPrintable(QString("%1 %2: %3").arg(precision, name).arg(off)));
      }
   }
}

/// Neighbours that turn against each other by more than half a radian take the general arc, beyond pi the
/// shorter way round; spins of more than 0.2 rad a step the long exponential.
void SolverBondsVectorTest::farTurnsAreExactAsWell()
{
   HandScene scene = blockOf(5, 4, 6, 0.05);
   kickAll(scene, 30);
   Run slow(scene, {.forceStep = 1, .instructions = "scalar"}), fast(scene, {.forceStep = 1}),
       single(scene, {.forceStep = 1, .precision = "f32"});
   QVERIFY2(slow.status == DIATOM_OK, slow.host.said.c_str());
   const double step = 0.2 * slow.estimate.stable_step;
   for (Run *run : {&slow, &fast, &single})
      QCOMPARE(run->to(30 * step, step), DIATOM_OK);
   const auto q = slow.read("rotation");
   double least = 1;
   for (std::size_t i = 0; i + 4 < q.size(); i += 4)
      least = std::min(least, std::abs(q[i]));
   QVERIFY2(least < 0.5, qPrintable(QString::number(least))); // turned by more than 2 rad
   for (const char *name : {"position", "rotation", "velocity"}) {
      QVERIFY2(apart(fast, slow, name) < 1e-11, qPrintable(QString::number(apart(fast, slow, name))));
      QVERIFY2(apart(single, slow, name) < 1e-3, qPrintable(QString::number(apart(single, slow, name))));
   }
}

void SolverBondsVectorTest::reproducibleRunsHaveTheSameBitsOnAnyInstructions_data()
{
   QTest::addColumn<QString>("kind");
   QTest::addColumn<QString>("precision");
   for (const char *kind : {"damped", "sparse", "askew", "everything", "flat boxes", "bricks"})
      for (const char *precision : {"f64", "f32"})
         QTest::addRow("%s, %s", kind, precision) << QString(kind) << QString(precision);
}

void SolverBondsVectorTest::reproducibleRunsHaveTheSameBitsOnAnyInstructions()
{
   QFETCH(QString, kind);
   QFETCH(QString, precision);
   HandScene scene = sceneOf(kind);
   kickAll(scene, 1);
   std::vector<double> first;
   for (const char *instructions : {"best", "avx2", "sse4"}) {
      Run run(scene, {.precision = precision.toStdString(), .reproducible = 1, .instructions = instructions});
      QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
      QCOMPARE(run.to(100 * run.estimate.stable_step), DIATOM_OK);
      const auto now = stateOf(run);
      if (first.empty())
         first = now;
      QVERIFY(std::memcmp(first.data(), now.data(), sizeof(double) * now.size()) == 0);
   }
}

void SolverBondsVectorTest::tilesAndThreadsDoNotChangeABit_data()
{
   QTest::addColumn<QString>("precision");
   QTest::newRow("f64") << "f64";
   QTest::newRow("f32") << "f32";
}

/// Several tiles, whose bonds to each other take another way, beside the motion of one bond at a time.
void SolverBondsVectorTest::tilesAndThreadsDoNotChangeABit()
{
   QFETCH(QString, precision);
   HandScene scene = blockOf(29, 31, 27, 0.1);
   kickAll(scene, 0.01);
   std::vector<double> first;
   for (const int threads : {1, 2, 3}) {
      Run run(scene, {.precision = precision.toStdString()}, threads);
      QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
      QCOMPARE(run.to(20 * run.estimate.stable_step), DIATOM_OK);
      auto now = stateOf(run);
      const auto energy = run.read("energy");
      now.insert(now.end(), energy.begin(), energy.end());
      if (first.empty())
         first = now;
      QVERIFY(now == first);
   }
   Run slow(scene, {.instructions = "scalar"}), fast(scene, {.precision = precision.toStdString()});
   for (Run *run : {&slow, &fast})
      QCOMPARE(run->to(20 * run->estimate.stable_step), DIATOM_OK);
   // Twenty steps of the stable length: rounding, some hundred times over.
   const double off = apart(fast, slow, "velocity");
   QVERIFY2(off < (precision == "f64" ? 1e-11 : 1e-4), qPrintable(QString::number(off)));
}

/// A free block drifts by a hundred of its cells. In displacements since rest, single precision leaves
/// strains of 100 * 6e-8 at most; two roundings of it meet in a bond.
void SolverBondsVectorTest::singlePrecisionStaysUnstrainedFarAway()
{
   HandScene scene = blockOf(6, 6, 6, 0.1);
   for (int i = 0; i < scene.cells(); ++i)
      scene.addRow("velocity", {0.1, 0.05, -0.02, 0, 0, 0}, i);
   Run run(scene, {.precision = "f32"});
   QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
   QCOMPARE(run.to(1), DIATOM_OK);
   double most = 0;
   for (const double strain : run.read("strain"))
      most = std::max(most, strain);
   qInfo("strain %.1e after 100 cells", most);
   QVERIFY2(most < 1.2e-5, qPrintable(QString::number(most)));
}

void SolverBondsVectorTest::whatItCannotDoIsSaid()
{
   HandScene scene = blockOf(3, 3, 3, 0);
   Run simple(scene, {.gradient = "simple", .precision = "f32"});
   QCOMPARE(simple.status, DIATOM_UNSUPPORTED);
   QVERIFY2(simple.host.said.find("simple gradient") != std::string::npos &&
                simple.host.said.find("f64") != std::string::npos,
            simple.host.said.c_str());
}

QTEST_APPLESS_MAIN(SolverBondsVectorTest)
#include "solver_bonds_vector_test.moc"
