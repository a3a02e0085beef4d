// The longest stable step from the highest eigenvalue of the whole scene: just below it motion stays bounded,
// just above it does not.
#include "solver_bonds_scene.h"

#include <QtTest>

#include <cmath>

using namespace diatom::test;

namespace {

std::map<std::string, double> stuff(double youngsModulus, double dampingRatio)
{
   return {{"density", 1200},
           {"youngs_modulus", youngsModulus},
           {"poisson_ratio", 0.3},
           {"damping_ratio", dampingRatio}};
}

/// A block of 5 x 4 x 3 cells, all of which move a little.
HandScene sceneOf(const QString &kind)
{
   HandScene scene(1e-3);
   const bool damped = kind == "damped" || kind == "everything";
   scene.addMaterial(stuff(1e6, damped ? 0.3 : 0));
   scene.addMaterial(stuff(3e7, damped ? 0.1 : 0));
   scene.addBlock(5, 4, 3);
   if (kind == "unlike" || kind == "everything")
      for (int i = 0; i < scene.cells(); ++i)
         scene.cellMaterial[i] = i % 2;
   scene.link();
   if (kind == "flat boxes")
      for (int i = 0; i < scene.cells(); ++i)
         scene.extent[3 * i + 1] *= 0.4;
   if (damped)
      scene.effects.push_back("damping");
   if (kind == "held" || kind == "everything")
      for (int i = 0; i < 12; ++i)
         scene.fix(i, i % 2 ? 63 : 7);
   if (kind == "on the ground" || kind == "everything") {
      scene.addRow("ground", {-0.501e-3, 2e5, 0.5, 0.4});
      scene.addRow("gravity", {0, 0, -9.81});
      for (const char *effect : {"ground", "friction", "gravity"})
         scene.effects.emplace_back(effect);
   }
   if (kind == "everything") {
      scene.addRow("drag", {40});
      scene.effects.push_back("drag");
   }
   kickAll(scene, 1e-4);
   return scene;
}

} // namespace

class SolverBondsStableStepTest : public QObject
{
   Q_OBJECT

private slots:
   void aSwingsLimitIsKnown();
   void motionStaysBoundedBelowTheLimit_data();
   void motionStaysBoundedBelowTheLimit();
   void motionGrowsAboveTheLimit_data();
   void motionGrowsAboveTheLimit();
   void aBlockMayTakeLongerStepsThanItsBondsSay();
   void whereNothingCanMoveNothingLimits();
   void theSearchCanBeCancelled();
};

/// Two cells that can but move along their bond swing at omega^2 = 2 k / m, k = E l, m = rho l^3. 1e-4 of
/// omega^2 is the margin that the search adds.
void SolverBondsStableStepTest::aSwingsLimitIsKnown()
{
   HandScene scene(1e-3);
   scene.addMaterial(stuff(1e6, 0));
   scene.addCell(0, 0, 0);
   scene.addCell(1, 0, 0);
   scene.link();
   for (int i = 0; i < 2; ++i)
      scene.fix(i, 62); // but along the bond
   Run run(scene, {.stableStep = "eigenvalue"});
   QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
   const double omega = std::sqrt(2 * 1e6 / 1200) / 1e-3;
   const double got = run.estimate.stable_step * omega / 2;
   QVERIFY2(std::abs(got - 1) < 1e-4, qPrintable(QString::number(got, 'g', 12)));
}

void SolverBondsStableStepTest::motionStaysBoundedBelowTheLimit_data()
{
   QTest::addColumn<QString>("kind");
   QTest::addColumn<QString>("integrator");
   for (const char *kind : {"plain", "unlike", "held", "flat boxes", "damped", "on the ground", "everything"})
      for (const char *integrator : {"semi_implicit", "verlet", "rk4"})
         QTest::addRow("%s, %s", kind, integrator) << kind << integrator;
}

/// An amplitude that grows by 1 % a step is 10^86 times as large after 20 000: whatever the solver calls
/// diverged has energy 40 times over. 0.999: with turns of some degrees, frequencies are not quite those at
/// rest.
void SolverBondsStableStepTest::motionStaysBoundedBelowTheLimit()
{
   QFETCH(QString, kind);
   QFETCH(QString, integrator);
   HandScene scene = sceneOf(kind);
   Run run(scene, {.integrator = integrator.toStdString(), .stableStep = "eigenvalue"});
   QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
   const double dt = 0.999 * run.estimate.stable_step;
   QCOMPARE(run.to(20000 * dt, dt), DIATOM_OK);
   QVERIFY2(run.result.state == DIATOM_DONE, run.host.said.c_str());
}

void SolverBondsStableStepTest::motionGrowsAboveTheLimit_data()
{
   QTest::addColumn<QString>("kind");
   QTest::addColumn<double>("above");
   // Semi-implicit Euler grows from there on; where the strongest damping is not that of the fastest
   // vibration, the two together are more than the limit says.
   QTest::newRow("plain") << "plain" << 1.01;
   QTest::newRow("unlike") << "unlike" << 1.01;
   QTest::newRow("held") << "held" << 1.01;
   QTest::newRow("flat boxes") << "flat boxes" << 1.01;
   QTest::newRow("damped") << "damped" << 1.05;
}

void SolverBondsStableStepTest::motionGrowsAboveTheLimit()
{
   QFETCH(QString, kind);
   QFETCH(double, above);
   HandScene scene = sceneOf(kind);
   Run run(scene, {.forceStep = 1, .stableStep = "eigenvalue"});
   QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
   const double dt = above * run.estimate.stable_step;
   run.to(20000 * dt, dt);
   QCOMPARE(run.result.state, std::int32_t{DIATOM_DIVERGED});
}

/// The bound is 1.1 to 1.4 times the highest frequency of blocks (model/stable_step.cpp), and never below it.
void SolverBondsStableStepTest::aBlockMayTakeLongerStepsThanItsBondsSay()
{
   HandScene scene = sceneOf("plain"), same = sceneOf("plain");
   Run bound(scene), known(same, {.stableStep = "eigenvalue"});
   const double gain = known.estimate.stable_step / bound.estimate.stable_step;
   qInfo("step over that of the bound: %.3f", gain);
   QVERIFY2(gain > 1.05 && gain < 1.5, qPrintable(QString::number(gain)));
   QCOMPARE(known.to(1, 1.001 * known.estimate.stable_step), DIATOM_LIMIT);
}

/// Then the bound's step holds.
void SolverBondsStableStepTest::whereNothingCanMoveNothingLimits()
{
   const auto heldAll = [] {
      HandScene scene(1e-3);
      scene.addMaterial(stuff(1e6, 0.1));
      scene.addBlock(2, 1, 1);
      scene.link();
      scene.effects.push_back("damping");
      scene.fix(0);
      scene.fix(1);
      return scene;
   };
   HandScene scene = heldAll(), same = heldAll();
   Run run(scene, {.stableStep = "eigenvalue"}), bound(same);
   QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
   QCOMPARE(run.estimate.stable_step, bound.estimate.stable_step);
   QCOMPARE(run.to(0.01), DIATOM_OK);
}

void SolverBondsStableStepTest::theSearchCanBeCancelled()
{
   HandScene scene = sceneOf("plain");
   Run run(scene, {.stableStep = "eigenvalue"}, 1, true);
   QCOMPARE(run.status, std::int32_t{DIATOM_CANCELLED});
   QVERIFY(!run.self);
}

QTEST_APPLESS_MAIN(SolverBondsStableStepTest)
#include "solver_bonds_stable_step_test.moc"
