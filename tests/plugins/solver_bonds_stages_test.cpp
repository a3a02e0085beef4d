// Integrators that are there to compare: explicit midpoint and forward Euler. Undamped, both gain energy at
// any step; how much is known exactly.
#include "solver_bonds_scene.h"

#include <QtTest>

#include <cmath>

using namespace diatom::test;

namespace {

/// Two free cells that swing along their bond, about a centre that rests.
HandScene swinging()
{
   HandScene scene(1e-3);
   scene.addMaterial(
       {{"density", 1200}, {"youngs_modulus", 1e6}, {"poisson_ratio", 0.3}, {"damping_ratio", 0.1}});
   scene.addBlock(2, 1, 1);
   scene.link();
   scene.addRow("velocity", {1e-4, 0, 0, 0, 0, 0}, 0);
   scene.addRow("velocity", {-1e-4, 0, 0, 0, 0, 0}, 1);
   return scene;
}

/// omega = sqrt(2 k / m) of that swing, with k = E l and m = rho l^3.
double frequency() { return std::sqrt(2 * 1e6 / 1200) / 1e-3; }

} // namespace

class SolverBondsStagesTest : public QObject
{
   Q_OBJECT

private slots:
   void aSwingGrowsAsTheTableSays_data();
   void aSwingGrowsAsTheTableSays();
   void theLongestStepIsWhereGrowthStaysSmall_data();
   void theLongestStepIsWhereGrowthStaysSmall();
   void dampedMotionStaysBounded_data();
   void dampedMotionStaysBounded();
   void errorsFallWithTheOrder_data();
   void errorsFallWithTheOrder();
};

void SolverBondsStagesTest::aSwingGrowsAsTheTableSays_data()
{
   QTest::addColumn<QString>("integrator");
   QTest::addColumn<QString>("instructions");
   QTest::addColumn<double>("y"); // omega dt
   QTest::addColumn<int>("steps");
   QTest::addColumn<double>("gain"); // of energy in a step
   const double slow = 0.1, fast = 0.5;
   for (const char *instructions : {"best", "scalar"}) {
      QTest::addRow("forward Euler, %s", instructions)
          << "forward_euler" << instructions << slow << 100 << 1 + slow * slow;
      QTest::addRow("midpoint, %s", instructions)
          << "midpoint" << instructions << fast << 200 << 1 + std::pow(fast, 4) / 4;
   }
}

/// The amplification of z = i omega dt: |1 + z|^2 = 1 + y^2, |1 + z + z^2/2|^2 = 1 + y^4/4. The swing is
/// linear (no turns), the energy is a quadratic form that each step multiplies by just that: 1e-9 is rounding
/// of some hundred steps.
void SolverBondsStagesTest::aSwingGrowsAsTheTableSays()
{
   QFETCH(QString, integrator);
   QFETCH(QString, instructions);
   QFETCH(double, y);
   QFETCH(int, steps);
   QFETCH(double, gain);
   HandScene scene = swinging();
   Run run(
       scene,
       {.integrator = integrator.toStdString(), .forceStep = 1, .instructions = instructions.toStdString()});
   QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
   const double dt = y / frequency(), before = run.stored();
   QCOMPARE(run.to(steps * dt, dt), DIATOM_OK);
   const double got = run.stored() / before, want = std::pow(gain, steps);
   QVERIFY2(std::abs(got / want - 1) < 1e-9, qPrintable(QString("%1, not %2").arg(got).arg(want)));
}

void SolverBondsStagesTest::theLongestStepIsWhereGrowthStaysSmall_data()
{
   QTest::addColumn<QString>("integrator");
   QTest::addColumn<double>("y");
   // 10^-5 a step of amplitude: y^2 = 2e-5 and y^4 / 4 = 2e-5, where semi-implicit Euler has y = 2.
   QTest::newRow("forward Euler") << "forward_euler" << std::sqrt(2e-5);
   QTest::newRow("midpoint") << "midpoint" << std::pow(8e-5, 0.25);
}

/// Without damping, against the exact 2 / omega of the same bound; 1e-6 is what halving an interval leaves.
void SolverBondsStagesTest::theLongestStepIsWhereGrowthStaysSmall()
{
   QFETCH(QString, integrator);
   QFETCH(double, y);
   HandScene scene = swinging(), same = swinging();
   Run usual(scene), one(same, {.integrator = integrator.toStdString()});
   QVERIFY2(one.status == DIATOM_OK, one.host.said.c_str());
   const double got = 2 * one.estimate.stable_step / usual.estimate.stable_step;
   QVERIFY2(std::abs(got / y - 1) < 1e-6, qPrintable(QString("%1, not %2").arg(got).arg(y)));
}

void SolverBondsStagesTest::dampedMotionStaysBounded_data()
{
   QTest::addColumn<QString>("integrator");
   QTest::newRow("forward Euler") << "forward_euler";
   QTest::newRow("midpoint") << "midpoint";
}

/// A damped block that is shaken in every way loses energy at the longest step that is allowed, and gains it
/// at three times that: the limit is safe, and no more than the bound on single bonds makes it.
void SolverBondsStagesTest::dampedMotionStaysBounded()
{
   QFETCH(QString, integrator);
   const auto shaken = [] {
      HandScene scene(1e-3);
      scene.addMaterial(
          {{"density", 1200}, {"youngs_modulus", 1e6}, {"poisson_ratio", 0.3}, {"damping_ratio", 0.1}});
      scene.addBlock(3, 2, 2);
      scene.link();
      scene.effects.push_back("damping");
      kickAll(scene, 0.01);
      return scene;
   };
   HandScene scene = shaken(), other = shaken();
   const std::string name = integrator.toStdString();
   Run run(scene, {.integrator = name, .safety = 1}), beyond(other, {.integrator = name, .forceStep = 1});
   QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
   const double dt = run.estimate.stable_step, before = run.stored();
   QCOMPARE(run.to(5000 * dt, dt), DIATOM_OK);
   QCOMPARE(run.result.state, std::int32_t{DIATOM_DONE});
   const double after = run.stored();
   QVERIFY2(after < before, qPrintable(QString("%1 J became %2 J").arg(before).arg(after)));
   beyond.to(5000 * 3 * dt, 3 * dt);
   QCOMPARE(beyond.result.state, std::int32_t{DIATOM_DIVERGED});
   HandScene asked = shaken();
   Run refused(asked, {.integrator = name});
   QCOMPARE(refused.to(1, 3 * dt), DIATOM_LIMIT);
}

void SolverBondsStagesTest::errorsFallWithTheOrder_data()
{
   QTest::addColumn<QString>("integrator");
   QTest::addColumn<double>("least");
   QTest::addColumn<double>("most");
   QTest::newRow("forward Euler") << "forward_euler" << 1.9 << 2.1;
   QTest::newRow("midpoint") << "midpoint" << 3.8 << 4.2;
}

/// The place of a swinging cell after a quarter of its swing, exactly (1 - cos)-like: against the closed
/// form, half the step makes half or a quarter of the error. 5 % is what the next order adds at 200 and 400
/// steps.
void SolverBondsStagesTest::errorsFallWithTheOrder()
{
   QFETCH(QString, integrator);
   QFETCH(double, least);
   QFETCH(double, most);
   const double omega = frequency(), until = 0.7 / omega;
   const auto error = [&](int steps) {
      HandScene scene = swinging();
      Run run(scene, {.integrator = integrator.toStdString(), .forceStep = 1});
      run.to(until, until / steps);
      return std::abs(run.read("position")[0] - 1e-4 * std::sin(omega * until) / omega);
   };
   const double ratio = error(200) / error(400);
   QVERIFY2(ratio > least && ratio < most, qPrintable(QString::number(ratio)));
}

QTEST_APPLESS_MAIN(SolverBondsStagesTest)
#include "solver_bonds_stages_test.moc"
