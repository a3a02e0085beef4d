// Implicit motion in time: order, dissipation, conservation, stability far beyond the explicit limit, and the
// same answers as exact solutions, fine explicit runs and static balances.
#include "solver_bonds_equilibrium_scene.h"
#include "solver_bonds_implicit_scene.h"

#include <numbers>

using namespace diatom::test;

class SolverBondsImplicitTest : public QObject
{
   Q_OBJECT
private slots:
   void trapezoidalStepsHaveTheirClosedForm();
   void oscillatorsConvergeWithTheSquareOfTheStep_data();
   void oscillatorsConvergeWithTheSquareOfTheStep();
   void numericalDampingTakesWhatIsTooFast_data();
   void numericalDampingTakesWhatIsTooFast();
   void numericalDampingSparesWhatIsResolved();
   void undampedEnergyStaysBounded();
   void aFreeBodyKeepsItsMomenta_data();
   void aFreeBodyKeepsItsMomenta();
   void aTopTumblesAsEulersEquationsSay();
   void aBarRollsUp();
   void aReleasedCantileverFollowsTheFineExplicitRun();
   void drivenCellsPullTheOthers();
   void signalsActuateToSecondOrder();
   void stepsFarBeyondTheLimitStayStable();
   void motionSettlesToTheStaticBalance();
   void loadsThatJumpActAtOnce();
   void threadsDoNotChangeABit();
   void cancelStopsAtOnce();
   void badInputIsRefusedInOneSentence();
};

/// Average acceleration: u = A sin(w' t) with tan(w' h / 2) = w h / 2 (Hughes, The Finite Element Method,
/// section 9.1), however long the step. Linear, so that rounding over 10^4 steps is all that is left.
void SolverBondsImplicitTest::trapezoidalStepsHaveTheirClosedForm()
{
   const Oscillator o;
   for (const double wh : {0.1, 1.0, 10.0}) {
      HandScene scene = o.scene();
      Run run(scene, implicit(0));
      QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
      const double h = wh / o.omega(), slow = 2 * std::atan(wh / 2) / h;
      for (const int steps : {7, 1000, 10000}) {
         QCOMPARE(run.to(steps * h, h), DIATOM_OK);
         const double exact = o.amplitude() * std::sin(slow * steps * h);
         QVERIFY2(
             std::abs(o.displacement(run) - exact) < 1e-8 * o.amplitude(),
             qPrintable(QString("%1 steps of %2: %3").arg(steps).arg(wh).arg(o.displacement(run) - exact)));
      }
      const auto energy = run.read("energy");
      QVERIFY(std::abs((energy[0] + energy[1]) / o.energy() - 1) < 1e-8);
   }
}

void SolverBondsImplicitTest::oscillatorsConvergeWithTheSquareOfTheStep_data()
{
   QTest::addColumn<double>("numericalDamping");
   QTest::addColumn<double>("dampingRatio");
   QTest::newRow("none") << 0.0 << 0.0;
   QTest::newRow("default") << 0.2 << 0.0;
   QTest::newRow("most") << 1.0 << 0.0;
   QTest::newRow("damped") << 0.2 << 0.3;
}

/// Against the exact solution over 2.3 swings; the measured order at 320 and 640 steps a swing is within 0.1
/// of 2, as the next term of the error is of third order.
void SolverBondsImplicitTest::oscillatorsConvergeWithTheSquareOfTheStep()
{
   QFETCH(double, numericalDamping);
   QFETCH(double, dampingRatio);
   const Oscillator o{dampingRatio};
   const double until = 2.3 * 2 * std::numbers::pi / o.omega();
   std::vector<double> errors;
   for (const int perSwing : {160, 320, 640}) {
      HandScene scene = o.scene();
      Run run(scene, implicit(numericalDamping));
      QCOMPARE(run.to(until, until / (2.3 * perSwing)), DIATOM_OK);
      errors.push_back(std::abs(o.displacement(run) - o.exact(until)) / o.amplitude());
   }
   const double order = std::log2(errors[1] / errors[2]);
   QVERIFY2(std::abs(order - 2) < 0.1 && errors[2] < 5e-3,
            qPrintable(QString("%1 %2 %3").arg(errors[0]).arg(errors[1]).arg(errors[2])));
}

void SolverBondsImplicitTest::numericalDampingTakesWhatIsTooFast_data()
{
   QTest::addColumn<double>("numericalDamping");
   for (const double d : {0.0, 0.2, 0.5})
      QTest::newRow(qPrintable(QString::number(d))) << d;
}

/// At w h = 10^4 the amplitude falls by the spectral radius in each step; a double root, so that the rate of
/// n steps more is (1 - d) (1 + O(1/n)): 5 % at 20 to 40 steps.
void SolverBondsImplicitTest::numericalDampingTakesWhatIsTooFast()
{
   QFETCH(double, numericalDamping);
   const Oscillator o;
   HandScene scene = o.scene();
   Run run(scene, implicit(numericalDamping));
   const double h = 1e4 / o.omega();
   run.to(20 * h, h);
   const double before = run.stored();
   run.to(40 * h, h);
   const double rate = std::pow(run.stored() / before, 1.0 / 40);
   QVERIFY2(std::abs(rate / (1 - numericalDamping) - 1) < (numericalDamping > 0 ? 0.05 : 1e-9),
            qPrintable(QString::number(rate)));
}

/// Loss per swing is of third order in the step: halving it makes the loss 8 times smaller (measured within
/// 10 %), and at 100 steps a swing it is below 0.1 % of the energy.
void SolverBondsImplicitTest::numericalDampingSparesWhatIsResolved()
{
   const Oscillator o;
   const double until = 5 * 2 * std::numbers::pi / o.omega();
   std::vector<double> losses; // in the second five swings: a start has a loss of its own, once
   for (const int perSwing : {50, 100}) {
      HandScene scene = o.scene();
      Run run(scene, implicit(0.2));
      QCOMPARE(run.to(until, until / (5 * perSwing)), DIATOM_OK);
      const double before = run.stored();
      QCOMPARE(run.to(2 * until, until / (5 * perSwing)), DIATOM_OK);
      losses.push_back(1 - run.stored() / before);
   }
   QVERIFY2(std::abs(losses[0] / losses[1] / 8 - 1) < 0.1 && losses[1] < 5e-3 && losses[1] > 0,
            qPrintable(QString("%1 %2").arg(losses[0]).arg(losses[1])));
}

/// A clamped rubber bar swings by a third of its length, without any damping, for 10^4 steps of 0.2 ms, some
/// thirty to a swing and seven times the explicit limit: the energy neither grows nor falls. The trapezoidal
/// rule keeps the energy of linear motion; what large rotations add is of the order of the step squared.
/// With twice that step it is lost without numerical damping (docs/implicit.md), and falls with the default.
void SolverBondsImplicitTest::undampedEnergyStaysBounded()
{
   HandScene scene = bar(6, 1e-3, kRubber);
   scene.analysis = "dynamics";
   for (int i = 1; i <= 6; ++i)
      scene.addRow("velocity", {0, 0, 2.0 * i * i / 36, 0, 0, 0}, i);
   Run run(scene, implicit(0));
   QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
   const double start = run.stored();
   double least = start, most = start, swing = 0, first = 0, last = 0;
   for (int look = 0; look < 1000; ++look) {
      QCOMPARE(run.to((look + 1) * 10 * 2e-4, 2e-4), DIATOM_OK);
      QVERIFY2(run.result.state == DIATOM_DONE, run.host.said.c_str());
      const double now = run.stored();
      least = std::min(least, now);
      most = std::max(most, now);
      swing = std::max(swing, std::abs(run.read("position")[3 * 6 + 2]));
      (look < 100 ? first : last) += look < 100 || look >= 900 ? now / 100 : 0;
   }
   Run damped(scene, implicit(0.2));
   double highest = 0;
   for (int look = 1; look <= 100; ++look) {
      QCOMPARE(damped.to(look * 25 * 4e-4, 4e-4), DIATOM_OK);
      QVERIFY2(damped.result.state == DIATOM_DONE, text(damped).c_str());
      highest = std::max(highest, damped.stored());
   }
   QVERIFY2(highest < start && damped.stored() > 0.8 * start,
            qPrintable(QString("%1, at last %2").arg(highest / start).arg(damped.stored() / start)));
   QVERIFY2(swing > 2e-3, qPrintable(QString::number(swing)));
   QVERIFY2(least > 0.95 * start && most < 1.05 * start && std::abs(last / first - 1) < 0.02,
            qPrintable(QString("%1 %2 %3 swing %4")
                           .arg(least / start)
                           .arg(most / start)
                           .arg(last / first - 1)
                           .arg(swing)));
}

void SolverBondsImplicitTest::aFreeBodyKeepsItsMomenta_data()
{
   QTest::addColumn<double>("numericalDamping");
   QTest::newRow("none") << 0.0;
   QTest::newRow("default") << 0.2;
}

/// A soft free block that flies, spins and breathes: linear momentum to rounding (the mean of forces that
/// cancel in pairs), angular momentum with an error that falls with the square of the step once the breathing
/// is resolved.
void SolverBondsImplicitTest::aFreeBodyKeepsItsMomenta()
{
   QFETCH(double, numericalDamping);
   std::vector<double> errors;
   for (const int perTurn : {1600, 3200}) {
      HandScene scene(1e-3);
      scene.addMaterial({{"density", 1100}, {"youngs_modulus", 1e6}, {"poisson_ratio", 0.3}});
      scene.addBlock(3, 2, 2);
      scene.link();
      const double w[3] = {100, -50, 150}, spin = std::sqrt(35000.0);
      for (int i = 0; i < scene.cells(); ++i) {
         const double *p = scene.position.data() + 3 * i;
         scene.addRow("velocity",
                      {0.3 + w[1] * p[2] - w[2] * p[1], w[2] * p[0] - w[0] * p[2], w[0] * p[1] - w[1] * p[0],
                       w[0], w[1], w[2]},
                      i);
      }
      Run run(scene, implicit(numericalDamping));
      const auto before = run.read("momentum");
      const double turn = 2 * std::numbers::pi / spin;
      QCOMPARE(run.to(turn, turn / perTurn), DIATOM_OK);
      const auto after = run.read("momentum");
      QVERIFY(std::abs(after[0] / before[0] - 1) < 1e-10);
      errors.push_back(difference(after, before, 3, 3));
   }
   QVERIFY2(errors[0] < 1e-3 && errors[0] / errors[1] > 3.5,
            qPrintable(QString("%1 %2").arg(errors[0]).arg(errors[1])));
}

/// A free box that spins about its middle axis, all but: Euler's equations by a Runge-Kutta of their own in
/// the body's axes. Order 2 within 0.15 over one tumble.
void SolverBondsImplicitTest::aTopTumblesAsEulersEquationsSay()
{
   const std::vector<double> extent{1e-3, 0.6e-3, 0.3e-3};
   const double spin[3] = {2, 100, 1}, until = 0.1;
   const auto exact = tumble(extent, spin, until);
   std::vector<double> errors;
   for (const int steps : {400, 800, 1600}) {
      HandScene scene(1e-3);
      scene.addMaterial({{"density", 1000}, {"youngs_modulus", 1e6}, {"poisson_ratio", 0.3}});
      scene.addCell(0, 0, 0);
      scene.extent = extent;
      scene.addRow("velocity", {0, 0, 0, spin[0], spin[1], spin[2]}, 0);
      Run run(scene, implicit(0.2));
      QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
      QCOMPARE(run.to(until, until / steps), DIATOM_OK);
      const auto turn = run.read("rotation");
      double dot = 0;
      for (std::size_t k = 0; k < 4; ++k)
         dot += turn[k] * exact[k];
      errors.push_back(2 * std::acos(std::min(1.0, std::abs(dot))));
   }
   const double order = std::log2(errors[1] / errors[2]);
   QVERIFY2(std::abs(order - 2) < 0.15 && errors[2] < 0.05,
            qPrintable(QString("%1 %2 %3").arg(errors[0]).arg(errors[1]).arg(errors[2])));
}

/// An end moment of 2 pi EI / L closes a bar to a circle (Love, Elasticity, article 255); each bond turns by
/// the same angle, so that the chain is exact. Dropped on at once, with drag, it comes to rest there.
void SolverBondsImplicitTest::aBarRollsUp()
{
   constexpr int kBonds = 20;
   HandScene scene = bar(kBonds, 1e-3, kRubber);
   scene.analysis = "dynamics";
   scene.effects.push_back("drag");
   scene.addRow("drag", {300});
   const double bending = 1e6 * 1e-12 / 12, moment = 2 * std::numbers::pi * bending / (kBonds * 1e-3);
   scene.addRow("force", {0, 0, 0, 0, moment, 0}, kBonds);
   Run run(scene, implicit(0.2));
   QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
   QCOMPARE(run.to(2, 1e-3), DIATOM_OK);
   QVERIFY2(run.result.state == DIATOM_DONE, run.host.said.c_str());
   const auto position = run.read("position"), turn = run.read("rotation");
   const double away = std::hypot(position[3 * kBonds], position[3 * kBonds + 2]);
   QVERIFY2(away < 1e-3 * kBonds * 1e-6, qPrintable(QString::number(away)));
   QVERIFY(std::abs(std::abs(turn[4 * kBonds]) - 1) < 1e-9);
   // Half way round, the bar stands opposite its root.
   QVERIFY(std::abs(position[3 * (kBonds / 2) + 2]) > 0.9 * kBonds * 1e-3 / std::numbers::pi);
}

/// The fine run is position Verlet at a fiftieth of its limit, whose own error is 1e-6 of the sag. Halving
/// the step makes the difference four times smaller, within 15 %.
void SolverBondsImplicitTest::aReleasedCantileverFollowsTheFineExplicitRun()
{
   const auto tipAt = [](const SolverChoice &choice, double until, double step) {
      HandScene scene = bar(5, 1e-3, kRubber);
      scene.analysis = "dynamics";
      scene.effects.push_back("gravity");
      scene.addRow("gravity", {0, 0, -40});
      Run run(scene, choice);
      run.to(until, step > 0 ? step : 0.02 * run.estimate.stable_step);
      return run.read("position")[3 * 5 + 2];
   };
   const double until = 3e-3;
   const double fine = tipAt({.integrator = "verlet"}, until, 0);
   std::vector<double> errors;
   for (const double step : {2e-5, 1e-5, 5e-6})
      errors.push_back(std::abs(tipAt(implicit(0.2), until, step) / fine - 1));
   const double ratio = errors[1] / errors[2];
   QVERIFY2(std::abs(ratio / 4 - 1) < 0.15 && errors[2] < 1e-3,
            qPrintable(QString("%1: %2 %3 %4").arg(fine).arg(errors[0]).arg(errors[1]).arg(errors[2])));
}

/// Cell 0 sets off at V: cell 1 follows as V t - (V / w) sin w t, and the curve does the work.
void SolverBondsImplicitTest::drivenCellsPullTheOthers()
{
   const Oscillator o;
   const double speed = 0.02, until = 2.3 * 2 * std::numbers::pi / o.omega();
   std::vector<double> errors, missing;
   for (const int perSwing : {80, 160}) {
      HandScene scene(1e-3);
      scene.addMaterial(o.material());
      scene.addBlock(2, 1, 1);
      scene.link();
      scene.fix(0, 62);
      scene.fix(1, 62);
      scene.effects.push_back("driven");
      scene.addRow("driven", {0, 0}, 0);
      scene.addRow("curve", {0, 0}, 0);
      scene.addRow("curve", {1, speed}, 0);
      Run run(scene, implicit(0.0));
      QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
      QCOMPARE(run.to(until, until / (2.3 * perSwing)), DIATOM_OK);
      const auto position = run.read("position");
      QVERIFY(std::abs(position[0] - speed * until) < 1e-15);
      const double exact = speed * until - speed / o.omega() * std::sin(o.omega() * until);
      errors.push_back(std::abs(position[3] - 1e-3 - exact) / (speed / o.omega()));
      missing.push_back(std::abs(run.balance()) / run.stored());
      // What the support supplies is the bond's pull, as nothing accelerates cell 0.
      const auto reaction = run.read("reaction");
      QVERIFY(std::abs(reaction[0] / (o.stiffness() * (position[3] - 1e-3 - position[0])) + 1) < 1e-6);
   }
   QVERIFY2(std::abs(errors[0] / errors[1] / 4 - 1) < 0.1 && errors[1] < 2e-3,
            qPrintable(QString("%1 %2").arg(errors[0]).arg(errors[1])));
   QVERIFY2(missing[1] < 1e-3, qPrintable(QString::number(missing[1])));
}

/// A sine of the actuator, against Runge-Kutta at a hundredth of its limit; the account of energies too.
void SolverBondsImplicitTest::signalsActuateToSecondOrder()
{
   const auto runTo = [](const SolverChoice &choice, double step, double *missing) {
      HandScene scene(1e-3);
      scene.addMaterial({{"density", 1000}, {"youngs_modulus", 1e6}, {"poisson_ratio", 0.3}});
      scene.addBlock(4, 1, 1);
      scene.link();
      scene.fix(0);
      scene.effects.push_back("actuation");
      scene.addRow("actuator", {2, 0, 0.5, 0, -1}, 1);
      scene.addRow("source", {0, 300, 0, 0.5, 0, 1}, 0);
      Run run(scene, choice);
      run.to(2e-3, step > 0 ? step : 0.01 * run.estimate.stable_step);
      if (missing)
         *missing = std::abs(run.balance()) / run.stored();
      const auto position = run.read("position");
      return std::hypot(position[9] - 3e-3, position[10], position[11]);
   };
   const double fine = runTo({.integrator = "rk4"}, 0, nullptr);
   std::vector<double> errors, missing(2);
   errors.push_back(std::abs(runTo(implicit(0.0), 1e-6, &missing[0]) / fine - 1));
   errors.push_back(std::abs(runTo(implicit(0.0), 5e-7, &missing[1]) / fine - 1));
   QVERIFY2(std::abs(errors[0] / errors[1] / 4 - 1) < 0.15 && errors[1] < 1e-2 && missing[1] < 1e-2,
            qPrintable(QString("%1: %2 %3, %4").arg(fine).arg(errors[0]).arg(errors[1]).arg(missing[1])));
}

/// Aluminium at 1 mm: the explicit limit is 0.14 us. 1000 times that, with a load put on at once: no energy
/// from nowhere in 2000 steps, and the end is the balance, which the numerical damping leads to.
void SolverBondsImplicitTest::stepsFarBeyondTheLimitStayStable()
{
   HandScene scene = bar(12, 1e-3, kAluminium);
   HandScene still = bar(12, 1e-3, kAluminium);
   scene.analysis = "dynamics";
   scene.effects.push_back("drag");
   scene.addRow("drag", {200});
   for (HandScene *one : {&scene, &still})
      one->addRow("force", {0, 5, 20, 0, 0, 0}, 12);
   Run explicitRun(scene), run(scene, implicit(0.2)), balance(still);
   QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
   QCOMPARE(run.estimate.stable_step, 0.0);
   const double step = 1000 * explicitRun.estimate.stable_step;
   QVERIFY(step > 5e-5 && step < 5e-4);
   for (int n = 1; n <= 20; ++n) {
      QCOMPARE(run.to(100 * n * step, step), DIATOM_OK);
      QVERIFY2(run.result.state == DIATOM_DONE, run.host.said.c_str());
      QVERIFY2(run.balance() < 1e-6 * run.read("energy")[5], qPrintable(QString("%1 of %2; %3 %4 %5")
                                                                            .arg(run.balance())
                                                                            .arg(run.read("energy")[5])
                                                                            .arg(run.read("energy")[0])
                                                                            .arg(run.read("energy")[1])
                                                                            .arg(run.read("energy")[4])));
   }
   QCOMPARE(balance.to(0), DIATOM_OK);
   QVERIFY(difference(run.read("position"), balance.read("position"), 0, 39) < 1e-9);
}

/// A rubber cantilever that sags by a third of its length and is braked by drag ends where the static balance
/// is, to the tolerance of the balance.
void SolverBondsImplicitTest::motionSettlesToTheStaticBalance()
{
   const auto scene = [](const char *analysis) {
      HandScene made = bar(10, 1e-3, {{"density", 1000}, {"youngs_modulus", 2e5}, {"poisson_ratio", 0.3}});
      made.analysis = analysis;
      made.effects = {"rotation", "gravity", "drag"};
      made.addRow("gravity", {0, 0, -20});
      made.addRow("drag", {100});
      return made;
   };
   HandScene moving = scene("dynamics"), still = scene("statics");
   Run run(moving, implicit(0.2)), balance(still);
   QCOMPARE(run.to(2, 2e-3), DIATOM_OK);
   QCOMPARE(balance.to(0), DIATOM_OK);
   const auto moved = run.read("position"), rested = balance.read("position");
   QVERIFY2(rested[3 * 10 + 2] < -3e-4, qPrintable(QString::number(rested[32])));
   QVERIFY2(difference(moved, rested, 0, 33) < 1e-8,
            qPrintable(QString::number(difference(moved, rested, 0, 33))));
}

/// A force that is put on later acts as one that is there from the start: the same motion, that much later.
void SolverBondsImplicitTest::loadsThatJumpActAtOnce()
{
   const auto made = [](double force) {
      HandScene scene = bar(4, 1e-3, kRubber);
      scene.analysis = "dynamics";
      scene.addRow("force", {0, 0, force, 0, 0, 0}, 4);
      return scene;
   };
   HandScene early = made(1e-3), late = made(0);
   Run a(early, implicit(0.2)), b(late, implicit(0.2));
   QCOMPARE(a.to(4e-3, 1e-5), DIATOM_OK);
   QCOMPARE(b.to(1e-3, 1e-5), DIATOM_OK);
   const std::int64_t where = 4;
   const double force[6] = {0, 0, 1e-3, 0, 0, 0};
   const diatom_channel channel{"force", 1, 6, &where, force};
   QCOMPARE(b.table->apply(b.self, &b.host.call, &channel, 1), DIATOM_OK);
   QCOMPARE(b.to(5e-3, 1e-5), DIATOM_OK);
   QVERIFY(difference(a.read("velocity"), b.read("velocity"), 0, 15) < 1e-9);
}

/// A block large enough for threads and for multigrid.
void SolverBondsImplicitTest::threadsDoNotChangeABit()
{
   std::vector<std::vector<double>> results;
   for (const int threads : {1, 2}) {
      HandScene scene(1e-3);
      scene.addMaterial(kAluminium);
      scene.addBlock(11, 10, 10);
      scene.link();
      for (int i = 0; i < 100; ++i)
         scene.fix(i);
      scene.effects.push_back("gravity");
      scene.addRow("gravity", {100, 0, -500});
      Run run(scene, implicit(0.2), threads);
      QCOMPARE(run.to(1e-4, 2e-5), DIATOM_OK);
      results.push_back(run.read("position"));
      const auto velocity = run.read("velocity");
      results.back().insert(results.back().end(), velocity.begin(), velocity.end());
   }
   QVERIFY(results[0] == results[1]);
}

void SolverBondsImplicitTest::cancelStopsAtOnce()
{
   HandScene scene = bar(4, 1e-3, kRubber);
   scene.analysis = "dynamics";
   Run run(scene, implicit(0.2));
   QCOMPARE(run.to(1e-3, 1e-5), DIATOM_OK);
   run.host.cancel = true;
   QCOMPARE(run.to(1, 1e-5), DIATOM_CANCELLED);
   QCOMPARE(run.result.time, 1e-3);
   run.host.cancel = false;
   QCOMPARE(run.to(2e-3, 1e-5), DIATOM_OK);
   QCOMPARE(run.result.time, 2e-3);
}

void SolverBondsImplicitTest::badInputIsRefusedInOneSentence()
{
   HandScene scene = bar(4, 1e-3, kRubber);
   scene.analysis = "dynamics";
   QCOMPARE(Run(scene, implicit(1.5)).status, DIATOM_BAD_INPUT);
   SolverChoice simple = implicit(0.2);
   simple.gradient = "simple";
   Run refused(scene, simple);
   QCOMPARE(refused.status, DIATOM_UNSUPPORTED);
   QVERIFY(refused.host.said.find("exact") != std::string::npos);
   Run run(scene, implicit(0.2));
   QCOMPARE(run.to(1, -1), DIATOM_BAD_INPUT);
   QCOMPARE(run.to(std::nan(""), 1e-3), DIATOM_BAD_INPUT);
}

QTEST_APPLESS_MAIN(SolverBondsImplicitTest)
#include "solver_bonds_implicit_test.moc"
