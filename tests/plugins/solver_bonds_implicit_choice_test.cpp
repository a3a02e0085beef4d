// Implicit steps whose length the motion sets, and implicit motion on the ground.
#include "solver_bonds_equilibrium_scene.h"
#include "solver_bonds_implicit_scene.h"

#include <numbers>

using namespace diatom::test;

namespace {

/// A cube on the ground, pushed along x by gravity that leans by `slope`.
HandScene slide(double friction, double slope)
{
   HandScene scene(1e-2);
   scene.addMaterial({{"density", 1000}, {"youngs_modulus", 1e6}, {"poisson_ratio", 0.3}});
   scene.addCell(0, 0, 0);
   scene.fix(0, 56); // its turns
   scene.effects = {"rotation", "gravity", "ground", "friction"};
   scene.addRow("gravity", {9.81 * std::sin(slope), 0, -9.81 * std::cos(slope)});
   scene.addRow("ground", {-5e-3, 1e3, 2, friction});
   return scene;
}

} // namespace

class SolverBondsImplicitChoiceTest : public QObject
{
   Q_OBJECT
private slots:
   void chosenStepsKeepTheTolerance();
   void chosenStepsEndWhereAsked();
   void slowMotionTakesLongSteps();
   void whatIsAskedOftenDoesNotChangeTheAnswer();
   void aFallingCubeComesToRestOnTheGround();
   void frictionSticksOrSlidesAsCoulombSays();
   void effortIsTold();
   void singlePrecisionIsRefused();
};

/// Against the exact swing: after 5 swings the error, mostly of phase, is within 2 pi 5 times the tolerance
/// that each radian may add, and falls with it.
void SolverBondsImplicitChoiceTest::chosenStepsKeepTheTolerance()
{
   const Oscillator o;
   const double until = 5.2 * 2 * std::numbers::pi / o.omega();
   double last = 4;
   for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
      HandScene scene = o.scene();
      Run run(scene, implicit(0.2, tolerance));
      QCOMPARE(run.to(until), DIATOM_OK);
      QCOMPARE(run.result.state, DIATOM_DONE);
      const double error = std::abs(o.displacement(run) - o.exact(until)) / o.amplitude();
      QVERIFY2(error < 2 * std::numbers::pi * 5.2 * tolerance && error < last / 4,
               qPrintable(QString("%1 at %2").arg(error).arg(tolerance)));
      last = error;
   }
}

void SolverBondsImplicitChoiceTest::chosenStepsEndWhereAsked()
{
   const Oscillator o;
   HandScene scene = o.scene();
   Run run(scene, implicit(0.2));
   for (int k = 1; k <= 50; ++k) {
      const double until = k * 0.37 / o.omega();
      QCOMPARE(run.to(until), DIATOM_OK);
      QCOMPARE(run.result.time, until);
   }
   // A few steps at a time, as a host does that wants to stay responsive.
   const double until = 100 / o.omega();
   QCOMPARE(run.to(until, 0, 3), DIATOM_OK);
   QCOMPARE(run.result.state, DIATOM_RUNNING);
   QCOMPARE(run.result.steps, 3);
   while (run.result.state == DIATOM_RUNNING)
      QCOMPARE(run.to(until, 0, 3), DIATOM_OK);
   QCOMPARE(run.result.time, until);
}

/// An aluminium bar whose end is moved by 10 um within a second: 10^7 explicit steps. What is followed is the
/// drive, in some tens of steps after the start.
void SolverBondsImplicitChoiceTest::slowMotionTakesLongSteps()
{
   HandScene scene = bar(8, 1e-3, kAluminium);
   scene.analysis = "dynamics";
   scene.fix(8, 2);
   scene.effects.push_back("driven");
   scene.addRow("driven", {2, 0}, 8);
   for (int k = 0; k <= 200; ++k)
      scene.addRow("curve", {k / 200.0, 5e-6 * (1 - std::cos(std::numbers::pi * k / 200))}, 0);
   HandScene still = scene;
   still.analysis = "statics";
   still.effects = {"rotation", "driven"};
   Run run(scene, implicit(0.2)), balance(still);
   QCOMPARE(run.to(1), DIATOM_OK);
   QVERIFY2(run.result.state == DIATOM_DONE, run.host.said.c_str());
   QVERIFY2(run.result.steps < 500, qPrintable(QString::number(run.result.steps)));
   QCOMPARE(balance.to(1), DIATOM_OK);
   QVERIFY(difference(run.read("position"), balance.read("position"), 0, 27) < 1e-6);
}

/// A record of 200 rows changes the steps, but not the motion by more than they may err.
void SolverBondsImplicitChoiceTest::whatIsAskedOftenDoesNotChangeTheAnswer()
{
   const auto made = [] {
      HandScene scene = bar(6, 1e-3, kRubber);
      scene.analysis = "dynamics";
      scene.effects.push_back("gravity");
      scene.addRow("gravity", {0, 0, -40});
      return scene;
   };
   HandScene one = made(), other = made();
   Run straight(one, implicit(0.2)), often(other, implicit(0.2));
   QCOMPARE(straight.to(0.02), DIATOM_OK);
   for (int k = 1; k <= 200; ++k)
      QCOMPARE(often.to(k * 1e-4), DIATOM_OK);
   const double a = straight.read("position")[20], b = often.read("position")[20];
   QVERIFY2(std::abs(a - b) < 0.02 * std::abs(b), qPrintable(QString("%1 %2").arg(a).arg(b)));
}

/// Dropped from 1 mm, with the ground's damping: it comes to rest m g / k deep, and the energies add up.
void SolverBondsImplicitChoiceTest::aFallingCubeComesToRestOnTheGround()
{
   HandScene scene = slide(0, 0);
   scene.effects = {"rotation", "gravity", "ground"};
   scene.channels["ground"].values = {-6e-3, 1e3, 2, 0};
   Run run(scene, implicit(0.2));
   QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
   QCOMPARE(run.to(2), DIATOM_OK);
   QVERIFY2(run.result.state == DIATOM_DONE, run.host.said.c_str());
   const double depth = 1e-3 * 9.81 / 1e3;
   QVERIFY2(std::abs(run.read("position")[2] + 1e-3 + depth) < 1e-3 * 1e-3,
            qPrintable(QString::number(run.read("position")[2], 'g', 12)));
   QCOMPARE(run.to(2.2, 1e-3), DIATOM_OK); // equal steps: chosen ones have grown too long to see it rest
   QVERIFY2(std::abs(run.read("position")[2] + 1e-3 + depth) < 1e-6 * depth,
            qPrintable(QString::number(run.read("position")[2], 'g', 12)));
   const auto energy = run.read("energy");
   QVERIFY2(std::abs(run.balance()) < 0.02 * energy[4],
            qPrintable(QString::number(run.balance() / energy[4])));
}

/// tan 0.2 = 0.203: with mu = 0.25 the cube stays, pulled into the friction spring by m g sin / k; with 0.1
/// it slides by g (sin - mu cos) t^2 / 2 once the ground carries it.
void SolverBondsImplicitChoiceTest::frictionSticksOrSlidesAsCoulombSays()
{
   const double slope = 0.2;
   HandScene rough = slide(0.25, slope), smooth = slide(0.1, slope);
   rough.addRow("pose", {0, 0, -1e-3 * 9.81 * std::cos(slope) / 1e3, 0, 0, 0}, 0);
   Run sticks(rough, implicit(0.2)), slides(smooth, implicit(0.2));
   QCOMPARE(sticks.to(0.5, 1e-4), DIATOM_OK);
   const double give = 1e-3 * 9.81 * std::sin(slope) / 1e3;
   QVERIFY2(std::abs(sticks.read("position")[0] / give - 1) < 1e-6,
            qPrintable(QString::number(sticks.read("position")[0] / give)));
   QCOMPARE(slides.to(0.5, 1e-3), DIATOM_OK);
   // The ground's spring has to be stretched first, so that the cube is ahead of the rigid law by some 0.2 %;
   // the explicit run knows that too.
   const double way = 0.5 * 9.81 * (std::sin(slope) - 0.1 * std::cos(slope)) * 0.25;
   Run beside(smooth, {.integrator = "verlet"});
   QCOMPARE(beside.to(0.5, 1e-5), DIATOM_OK);
   const double went = slides.read("position")[0], wanted = beside.read("position")[0];
   QVERIFY2(std::abs(went / way - 1) < 5e-3 && std::abs(went / wanted - 1) < 5e-4,
            qPrintable(QString("%1 %2").arg(went / way).arg(went / wanted)));
   QVERIFY(std::abs(slides.balance()) < 1e-3 * slides.read("energy")[4]);
}

void SolverBondsImplicitChoiceTest::effortIsTold()
{
   const Oscillator o;
   HandScene scene = o.scene();
   Run run(scene, implicit(0.2));
   QCOMPARE(run.to(1e-3, 1e-5), DIATOM_OK);
   const auto effort = run.read("effort");
   QCOMPARE(effort[0], 100.0);
   QVERIFY(effort[1] >= 100 && effort[1] == double(run.result.iterations));
   QCOMPARE(effort[2], 1.0); // a linear scene and one step length: factorised once
   QVERIFY(std::abs(effort[4] / 1e-5 - 1) < 1e-9 && std::abs(effort[5] / 1e-5 - 1) < 1e-9);
}

void SolverBondsImplicitChoiceTest::singlePrecisionIsRefused()
{
   HandScene scene = Oscillator().scene();
   SolverChoice choice = implicit(0.2);
   choice.precision = "f32";
   Run run(scene, choice);
   QCOMPARE(run.status, DIATOM_UNSUPPORTED);
   QVERIFY2(run.host.said.find("f64") != std::string::npos, run.host.said.c_str());
}

QTEST_APPLESS_MAIN(SolverBondsImplicitChoiceTest)
#include "solver_bonds_implicit_choice_test.moc"
