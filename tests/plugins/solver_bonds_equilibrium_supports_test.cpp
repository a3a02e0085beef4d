// Static balances: what drives, holds and loads the cells, what cannot be balanced and why.
#include "solver_bonds_equilibrium_scene.h"

using namespace diatom::test;

class SolverBondsEquilibriumSupportsTest : public QObject
{
   Q_OBJECT
private slots:
   void drivenCellsTurnAboutTiltedAxes();
   void drivenCellsFollowTheirCurves();
   void fullyDrivenCellsArePlacedWhereverTheyAre();
   void actuatorsReachTheirFreeShape();
   void blocksSinkIntoTheGround();
   void looseParts_data();
   void looseParts();
   void hugeContrastsBalance();
   void denseBlocksBalanceWithTheSameBitsOnAnyThreads();
   void wrongQuestionsAreRefusedInOneSentence();
   void cancelStops();
};

/// Nothing but the drive pulls: the whole bar turns with its first cell, by 2.5 rad about a skew axis.
/// Rounding.
void SolverBondsEquilibriumSupportsTest::drivenCellsTurnAboutTiltedAxes()
{
   const double l = 1e-2, angle[3] = {1.5, -1.2, 1.6};
   HandScene scene = bar(3, l, kRubber);
   scene.channels.erase("fixed");
   for (int k = 0; k < 3; ++k) {
      drive(scene, 0, k, 1e-3 * (k + 1));
      drive(scene, 0, 3 + k, angle[k]);
   }
   Run run(scene);
   QVERIFY2(run.to(1) == DIATOM_OK, text(run).c_str());
   QVERIFY2(run.result.state == DIATOM_CONVERGED, text(run).c_str());
   const double size = std::sqrt(1.5 * 1.5 + 1.2 * 1.2 + 1.6 * 1.6);
   const auto q = run.read("rotation"), p = run.read("position");
   const double half = 0.5 * size, f = std::sin(half) / size;
   const double turn[4] = {std::cos(half), f * angle[0], f * angle[1], f * angle[2]};
   // First column of the rotation matrix: where the bar points.
   const double along[3] = {1 - 2 * (turn[2] * turn[2] + turn[3] * turn[3]),
                            2 * (turn[1] * turn[2] + turn[0] * turn[3]),
                            2 * (turn[1] * turn[3] - turn[0] * turn[2])};
   for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < 4; ++k)
         QVERIFY(std::abs(q[4 * i + k] - turn[k]) < 1e-10);
      for (int k = 0; k < 3; ++k)
         QVERIFY(std::abs(p[3 * i + k] - (1e-3 * (k + 1) + i * l * along[k])) < 1e-10 * l);
   }
   QVERIFY(std::abs(run.read("reaction")[0]) < 1e-9); // of some 1e4 N/m
}

/// A bar stretched by its driven end: force of springs in series, and half way at half the time.
void SolverBondsEquilibriumSupportsTest::drivenCellsFollowTheirCurves()
{
   const double l = 1e-2;
   HandScene scene = bar(4, l, kRubber);
   drive(scene, 4, 0, 2e-3);
   Run run(scene);
   for (const double time : {0.5, 1.0, 0.25}) {
      QVERIFY2(run.to(time) == DIATOM_OK, text(run).c_str());
      QCOMPARE(run.result.state, DIATOM_CONVERGED);
      QCOMPARE(run.result.time, time);
      const auto r = run.read("reaction");
      const double force = 1e6 * l / 4 * 2e-3 * time; // E l a bond
      QVERIFY(std::abs(r[24] / force - 1) < 1e-9);
      QVERIFY(std::abs(r[0] / force + 1) < 1e-9);
      QVERIFY(std::abs(run.read("position")[12] - (4 * l + 2e-3 * time)) < 1e-15);
      QVERIFY(std::abs(run.read("internal_force")[24] / force + 1) < 1e-9);
   }
}

/// Nothing is free: turns of 3 rad about axes that lead the two cells through half a turn of each other on
/// the way are no way at all. In the end they are turned alike and stretched by 1 %: the force is k times
/// that.
void SolverBondsEquilibriumSupportsTest::fullyDrivenCellsArePlacedWhereverTheyAre()
{
   const double pitch = 0.01, stretch = 1e-4;
   HandScene scene = bar(1, pitch, kRubber);
   scene.channels.erase("fixed");
   const double turn = 3, other = 2 * M_PI - turn; // the same turn about z, the other way round
   const double place[2][3] = {
       {0, 0, 0}, {(pitch + stretch) * std::cos(turn) - pitch, (pitch + stretch) * std::sin(turn), 0}};
   for (int cell = 0; cell < 2; ++cell) {
      for (int k = 0; k < 3; ++k)
         drive(scene, cell, k, place[cell][k]);
      drive(scene, cell, 3, 0);
      drive(scene, cell, 4, 0);
      drive(scene, cell, 5, cell == 0 ? turn : -other);
   }
   Run run(scene);
   QVERIFY2(run.to(1) == DIATOM_OK, text(run).c_str());
   QCOMPARE(run.result.state, DIATOM_CONVERGED);
   const double force = 1e6 * pitch * stretch; // E A / l times the stretch
   const auto internal = run.read("internal_force"), reaction = run.read("reaction");
   // 1e-10 is rounding of places over a stretch of 1 %.
   QVERIFY(std::abs(internal[0] / (force * std::cos(turn)) - 1) < 1e-10);
   QVERIFY(std::abs(internal[1] / (force * std::sin(turn)) - 1) < 1e-10);
   for (std::size_t k = 0; k < 12; ++k)
      QCOMPARE(reaction[k], -internal[k]);
}

/// Constant voltage (a square wave that is always high, 0.5 V peak): the free shape follows from
/// amoeba.md 4.2 alone, free of force.
void SolverBondsEquilibriumSupportsTest::actuatorsReachTheirFreeShape()
{
   for (int mode = 0; mode < 4; ++mode) {
      HandScene scene = bar(2, 1e-3, kRubber);
      scene.effects = {"rotation", "actuation"};
      scene.addRow("source", {1, 1, 0, 1, 0, 1}, 0);
      scene.addRow("actuator", {double(mode), 0, 0.4, 0, -1}, 1); // strain 0.2 of the middle cell
      Run run(scene);
      QVERIFY2(run.to(0) == DIATOM_OK, text(run).c_str());
      QVERIFY2(run.result.state == DIATOM_CONVERGED, text(run).c_str());
      const double l = 1e-3, a = 0.1; // half of the strain in each bond
      const double x[4] = {2 * l * (1 + a), 2 * l, l * (std::cos(a / 2) + std::cos(1.5 * a)), 2 * l};
      const double y[4] = {0, 2 * l * a, l * (std::sin(a / 2) + std::sin(1.5 * a)), 0};
      const auto p = run.read("position");
      QVERIFY2(std::hypot(p[6] - x[mode], p[7] - y[mode], p[8]) < 1e-9 * l,
               qPrintable(QString("mode %1: %2 %3 %4").arg(mode).arg(p[6]).arg(p[7]).arg(p[8])));
      QVERIFY(run.read("energy")[1] < 1e-12 * 1e6 * l * l * l); // no strain left
   }
}

/// A plate laid on the ground, kept from sliding by one cell: every cell of it sinks by weight over
/// stiffness.
void SolverBondsEquilibriumSupportsTest::blocksSinkIntoTheGround()
{
   const double l = 1e-2;
   HandScene scene(l);
   scene.analysis = "statics";
   scene.addMaterial(kRubber);
   scene.addBlock(3, 3, 1);
   scene.link();
   scene.fix(0, 0b100011);
   scene.effects = {"rotation", "gravity", "ground"};
   scene.addRow("gravity", {0, 0, -9.81});
   scene.addRow("ground", {-l / 2, 2000, 0, 0});
   Run run(scene);
   QVERIFY2(run.to(0) == DIATOM_OK, text(run).c_str());
   QVERIFY2(run.result.state == DIATOM_CONVERGED, text(run).c_str());
   const double sunk = 1000 * l * l * l * 9.81 / 2000;
   for (int i = 0; i < 9; ++i)
      QVERIFY(std::abs(run.read("position")[3 * i + 2] + sunk) < 1e-9 * sunk);
}

void SolverBondsEquilibriumSupportsTest::looseParts_data()
{
   QTest::addColumn<int>("first");
   QTest::addColumn<int>("last");
   QTest::addColumn<QString>("said");
   QTest::newRow("free") << 0 << 0 << "(0, 0, 0) belongs to is free to move along x";
   QTest::newRow("x held") << 0b000001 << 0 << "move along y";
   QTest::newRow("hinged in space") << 0b000111 << 0 << "turn about x";
   QTest::newRow("held on a line") << 0b000111 << 0b000111 << "turn about x";
   QTest::newRow("shaft") << 0b001111 << 0b000110 << "";
   QTest::newRow("clamped") << 0b111111 << 0 << "";
}

/// The bar's ends are held as the masks say.
void SolverBondsEquilibriumSupportsTest::looseParts()
{
   QFETCH(int, first);
   QFETCH(int, last);
   QFETCH(QString, said);
   HandScene scene = bar(3, 1e-2, kRubber);
   scene.channels.erase("fixed");
   scene.fix(0, first);
   scene.fix(3, last);
   scene.addRow("force", {0, 0, 1e-3, 0, 0, 0}, 2);
   Run run(scene);
   QCOMPARE(run.to(0), said.isEmpty() ? DIATOM_OK : DIATOM_BAD_INPUT);
   QVERIFY2(said.isEmpty() || text(run).find(said.toStdString()) != std::string::npos, text(run).c_str());
}

/// Stiffnesses 10^6 apart: a bar's stretch is that of springs in series, and a block of random cells of both
/// kinds carries its weight. Reactions are sums of forces balanced to 1e-9 of the largest.
void SolverBondsEquilibriumSupportsTest::hugeContrastsBalance()
{
   const double l = 1e-2;
   Props steel = kRubber;
   steel["youngs_modulus"] = 1e12;
   {
      HandScene scene = bar(4, l, kRubber);
      scene.addMaterial(steel);
      scene.cellMaterial = {1, 1, 0, 0, 1};
      scene.addRow("force", {1, 0, 0, 0, 0, 0}, 4);
      Run run(scene);
      QVERIFY2(run.to(0) == DIATOM_OK, text(run).c_str());
      QCOMPARE(run.result.state, DIATOM_CONVERGED);
      const double soft = 1 / (1e6 * l), stiff = 1 / (1e12 * l);
      const double stretch = stiff + (soft + stiff) / 2 + soft + (soft + stiff) / 2;
      QVERIFY(std::abs(run.read("position")[12] - 4 * l - stretch) < 1e-9 * stretch);
   }
   HandScene scene(l);
   scene.analysis = "statics";
   scene.effects = {"rotation", "gravity"};
   scene.addMaterial(kRubber);
   scene.addMaterial(steel);
   scene.addBlock(6, 6, 12);
   unsigned random = 12345;
   for (int &material : scene.cellMaterial)
      material = static_cast<int>((random = random * 1664525 + 1013904223) >> 31);
   scene.link();
   for (const auto &[at, cell] : scene.at)
      if (at[2] == 0)
         scene.fix(cell);
   scene.addRow("gravity", {0, 0, -9.81});
   Run run(scene);
   QVERIFY2(run.to(0) == DIATOM_OK, text(run).c_str());
   QVERIFY2(run.result.state == DIATOM_CONVERGED, text(run).c_str());
   QVERIFY(run.result.residual < 1e-9);
   double sum = 0;
   const auto reaction = run.read("reaction");
   for (int i = 0; i < scene.cells(); ++i)
      sum += reaction[6 * i + 2];
   QVERIFY(std::abs(sum / (6 * 6 * 12 * 1000 * l * l * l * 9.81) - 1) < 1e-7);
}

/// Large enough for multigrid and threads. The block is uniform in no direction: its sides are free.
void SolverBondsEquilibriumSupportsTest::denseBlocksBalanceWithTheSameBitsOnAnyThreads()
{
   const int n = 11;
   const double l = 1e-2;
   HandScene scene(l);
   scene.analysis = "statics";
   scene.addMaterial(kRubber);
   scene.addBlock(n, n, n);
   scene.link();
   for (const auto &[at, cell] : scene.at)
      if (at[0] == 0)
         scene.fix(cell);
   scene.effects = {"rotation", "gravity"};
   scene.addRow("gravity", {0, 0, -9.81});
   std::vector<double> places[2];
   for (const int threads : {1, 2}) {
      Run run(scene, {}, threads);
      QVERIFY2(run.to(0) == DIATOM_OK, text(run).c_str());
      QVERIFY2(run.result.state == DIATOM_CONVERGED, text(run).c_str());
      QVERIFY(run.result.residual < 1e-9 && run.result.iterations > 0);
      places[threads - 1] = run.read("position");
      double sum = 0;
      const auto reaction = run.read("reaction");
      for (int i = 0; i < scene.cells(); ++i)
         sum += reaction[6 * i + 2];
      QVERIFY(std::abs(sum / (n * n * n * 1000 * l * l * l * 9.81) - 1) < 1e-7);
   }
   QVERIFY(places[0] == places[1]);
}

void SolverBondsEquilibriumSupportsTest::wrongQuestionsAreRefusedInOneSentence()
{
   const auto refused = [](auto change, const char *word) {
      HandScene scene = bar(2, 1e-2, kRubber);
      change(scene);
      Run run(scene);
      if (run.status == DIATOM_OK)
         run.to(0);
      return (run.status != DIATOM_OK || run.result.state == DIATOM_DIVERGED) &&
             text(run).find(word) != std::string::npos;
   };
   QVERIFY(refused([](HandScene &s) { s.analysis = "thermal"; }, "thermal"));
   QVERIFY(refused([](HandScene &s) { s.addRow("driven", {6, 0}, 1); }, "(1, 0, 0)"));
   QVERIFY(refused([](HandScene &s) { s.addRow("driven", {0, 0}, 1); }, "no points"));
   QVERIFY(refused(
       [](HandScene &s) {
          drive(s, 1, 0, 1e-3);
          s.addRow("curve", {0.5, 0}, 0);
       },
       "do not ascend"));
   QVERIFY(refused(
       [](HandScene &s) {
          s.effects = {"rotation", "ground", "friction"};
          s.addRow("ground", {0, 1000, 0, 0.5});
       },
       "friction"));
   QVERIFY(refused(
       [](HandScene &s) { // a hinge without any stiffness
          s.materials[0].property = {{"density", 1000}};
          for (const char *name : {"axial_x", "axial_y", "axial_z", "shear_xy", "shear_xz", "shear_yx",
                                   "shear_yz", "shear_zx", "shear_zy", "torsion_x", "torsion_y", "torsion_z"})
             s.materials[0].property[name] = 100;
          for (const char *name : {"bending_x", "bending_y", "bending_z"})
             s.materials[0].property[name] = 0;
          s.addRow("force", {0, 0, 1, 0, 0, 0}, 2);
       },
       "nothing resists"));
}

void SolverBondsEquilibriumSupportsTest::cancelStops()
{
   HandScene scene = bar(8, 1e-2, kRubber);
   scene.addRow("force", {0, 0, 0.5, 0, 0, 0}, 8);
   Run run(scene);
   run.host.cancel = true;
   QCOMPARE(run.to(0), DIATOM_CANCELLED);
   run.host.cancel = false;
   QCOMPARE(run.to(0), DIATOM_OK);
   QCOMPARE(run.result.state, DIATOM_CONVERGED);
}

QTEST_APPLESS_MAIN(SolverBondsEquilibriumSupportsTest)
#include "solver_bonds_equilibrium_supports_test.moc"
