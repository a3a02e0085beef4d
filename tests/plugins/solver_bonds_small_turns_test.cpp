// With the effect "rotation" off, strains are linear in displacements and turns: answers of linear beam
// theory, exactly, and what tells that it does not hold.
#include "solver_bonds_equilibrium_scene.h"

using namespace diatom::test;

namespace {

HandScene small(HandScene scene)
{
   std::erase(scene.effects, "rotation");
   return scene;
}

double tip(Run &run, int freedom)
{
   const auto all = run.read("position");
   return all[all.size() - 3 + static_cast<std::size_t>(freedom)];
}

} // namespace

class SolverBondsSmallTurnsTest : public QObject
{
   Q_OBJECT
private slots:
   void aBarSagsAsTheLinearBeam();
   void unlikeHalvesAreExactAsWell();
   void twiceTheLoadIsTwiceTheSagToRounding();
   void momentsThatTurnABarAroundOnlyBendIt();
   void vibrationsOfOnePartInAThousandAgree();
   void energyAndMomentumAreKept();
   void boxesKeepTheirInertia();
   void largeTurnsAreToldOnce();
   void whatAlwaysTurnsIsRefused();
};

/// Timoshenko's beam with a force at its tip, F L^3 / 3 E I + F L / G A_s (Timoshenko and Gere, Mechanics of
/// Materials): a bond is that beam, so that 1e-9 is rounding.
void SolverBondsSmallTurnsTest::aBarSagsAsTheLinearBeam()
{
   constexpr double kPitch = 1e-3, kForce = 1e-3, kE = 1e6;
   constexpr int kBonds = 20;
   HandScene scene = small(bar(kBonds, kPitch, kRubber));
   scene.addRow("force", {0, 0, -kForce, 0, 0, 0}, kBonds);
   Run run(scene);
   QVERIFY2(run.status == DIATOM_OK, text(run).c_str());
   QCOMPARE(run.to(1), DIATOM_OK);
   QCOMPARE(run.result.state, DIATOM_CONVERGED);
   QVERIFY(run.result.iterations <= 1);
   const double length = kBonds * kPitch, inertia = std::pow(kPitch, 4) / 12;
   const double shear = 5.0 / 6 * kE / 2.6 * kPitch * kPitch;
   const double exact = kForce * std::pow(length, 3) / (3 * kE * inertia) + kForce * length / shear;
   const double sag = -tip(run, 2);
   QVERIFY2(std::abs(sag / exact - 1) < 1e-9, qPrintable(QString("%1 of %2").arg(sag).arg(exact)));
   QVERIFY2(text(run).find("rotation is switched off") != std::string::npos, text(run).c_str());
}

/// Two half beams end to end: the tip of one bond whose halves are of E and 4 E, clamped at a, by a force at
/// b. Each half bends by its own moments: F l^3 / 24 E I of the softer half at the tip, the other's by its
/// own.
void SolverBondsSmallTurnsTest::unlikeHalvesAreExactAsWell()
{
   constexpr double kPitch = 1e-3, kForce = 1e-6, kE = 1e6;
   HandScene scene(kPitch);
   scene.analysis = "statics";
   scene.addMaterial({{"density", 1000}, {"youngs_modulus", kE}, {"poisson_ratio", 0.3}});
   scene.addMaterial({{"density", 1000}, {"youngs_modulus", 4 * kE}, {"poisson_ratio", 0.3}});
   scene.addCell(0, 0, 0, 0);
   scene.addCell(1, 0, 0, 1);
   scene.link();
   scene.fix(0);
   scene.effects = {"loads"};
   scene.addRow("force", {0, kForce, 0, 0, 0, 0}, 1);
   Run run(scene, {.beam = "euler"});
   QVERIFY2(run.status == DIATOM_OK, text(run).c_str());
   QCOMPARE(run.to(1), DIATOM_OK);
   // Unit load: integral of F (l - x)^2 / E I dx over 0..l/2 with E and l/2..l with 4 E.
   const double inertia = std::pow(kPitch, 4) / 12, l3 = std::pow(kPitch, 3);
   const double exact = kForce / (kE * inertia) * (l3 * 7 / 24 + l3 / 24 / 4);
   const double found = tip(run, 1);
   QVERIFY2(std::abs(found / exact - 1) < 1e-9, qPrintable(QString("%1 of %2").arg(found).arg(exact)));
}

void SolverBondsSmallTurnsTest::twiceTheLoadIsTwiceTheSagToRounding()
{
   double sag[2];
   for (int i = 0; i < 2; ++i) {
      HandScene scene = small(bar(20, 1e-3, kRubber));
      scene.addRow("force", {0, 0, -1e-3 * (i + 1), 0, 0, 0}, 20);
      Run run(scene);
      QCOMPARE(run.to(1), DIATOM_OK);
      sag[i] = tip(run, 2);
   }
   QVERIFY(std::abs(sag[1] / sag[0] - 2) < 1e-12);
}

/// An end moment that would roll the bar to a circle: the linear beam's end goes to M L^2 / 2 E I, and no
/// nearer to the clamp; the turn adds up to 2 pi. The tip of n bonds is exact for a moment.
void SolverBondsSmallTurnsTest::momentsThatTurnABarAroundOnlyBendIt()
{
   constexpr double kPitch = 1e-3, kE = 1e6, kPi = 3.14159265358979323846;
   constexpr int kBonds = 20;
   const double length = kBonds * kPitch, inertia = std::pow(kPitch, 4) / 12,
                moment = 2 * kPi * kE * inertia / length;
   HandScene scene = small(bar(kBonds, kPitch, kRubber));
   scene.addRow("force", {0, 0, 0, 0, 0, moment}, kBonds);
   Run run(scene);
   QCOMPARE(run.to(1), DIATOM_OK);
   const double up = moment * length * length / (2 * kE * inertia);
   QVERIFY2(std::abs(tip(run, 1) / up - 1) < 1e-9, qPrintable(QString::number(tip(run, 1) / up)));
   QVERIFY(std::abs(tip(run, 0) / length - 1) < 1e-12);
   const auto q = run.read("rotation"); // a full turn is none
   QVERIFY(std::abs(std::abs(q[q.size() - 4]) - 1) < 1e-9);
}

/// A bar that swings by a thousandth of its length: what is left out is of the square of the turns, 1e-6 of
/// the motion, times the some thirty radians of phase that it may add up over.
void SolverBondsSmallTurnsTest::vibrationsOfOnePartInAThousandAgree()
{
   for (const char *instructions : {"best", "scalar"}) {
      std::vector<double> ends[2];
      for (const bool all : {false, true}) {
         HandScene scene = bar(10, 1e-3, kRubber);
         scene.analysis = "dynamics";
         if (!all)
            scene = small(scene);
         scene.addRow("force", {0, 0, -2e-6, 0, 0, 0}, 10);
         Run run(scene, {.integrator = "rk4", .instructions = instructions});
         QVERIFY2(run.status == DIATOM_OK, text(run).c_str());
         QCOMPARE(run.to(0.02), DIATOM_OK);
         ends[all] = run.read("position");
      }
      double most = 0, apart = 0;
      for (std::size_t i = 2; i < ends[0].size(); i += 3) {
         most = std::max(most, std::abs(ends[1][i]));
         apart = std::max(apart, std::abs(ends[0][i] - ends[1][i]));
      }
      qInfo("%s: %.2e apart in %.2e m", instructions, apart, most);
      QVERIFY(most > 1e-6);
      QVERIFY2(apart < 3e-5 * most, qPrintable(QString::number(apart / most)));
      QVERIFY(apart > 0); // another law, not the same
   }
}

/// Verlet's energy swings with the square of the step and does not drift; the sum of forces is none. A linear
/// scene keeps linear momentum to rounding; angular momentum about a point belongs to the exact law.
void SolverBondsSmallTurnsTest::energyAndMomentumAreKept()
{
   HandScene scene(1e-3);
   scene.addMaterial(kRubber);
   scene.addBlock(6, 5, 4);
   scene.link();
   scene.effects.clear();
   kickAll(scene, 0.05);
   Run run(scene, {.integrator = "verlet"});
   QVERIFY2(run.status == DIATOM_OK, text(run).c_str());
   const double step = 0.3 * run.estimate.stable_step, start = run.stored();
   const auto momentum = run.read("momentum");
   double least = start, most = start;
   for (int i = 1; i <= 20; ++i) {
      QCOMPARE(run.to(i * 500 * step, step), DIATOM_OK);
      least = std::min(least, run.stored());
      most = std::max(most, run.stored());
   }
   qInfo("energy %.3e to %.3e of %.3e J", least, most, start);
   QVERIFY(most - least < 0.03 * start); // (0.3)^2 / 4 of the fastest vibration's, which has less than all
   const auto after = run.read("momentum");
   for (std::size_t k = 0; k < 3; ++k) // 1e4 steps of rounding in what 120 cells sum to
      QVERIFY(std::abs(after[k] - momentum[k]) < 1e-12 * 120 * 1e-6 * 0.05);
}

/// A free pair of flat boxes that spins about all axes: tumbling is of second order and left out, so that the
/// energy stays. Integrators keep it to the square of the step, here a tenth of the longest stable one.
void SolverBondsSmallTurnsTest::boxesKeepTheirInertia()
{
   for (const char *instructions : {"best", "scalar"})
      for (const char *integrator : {"semi_implicit", "rk4"}) {
         HandScene scene(1e-3);
         scene.addMaterial(kRubber);
         scene.addBlock(2, 1, 1);
         for (const int i : {0, 1}) {
            scene.extent[i == 0 ? 2 : 5] *= 0.4; // along z
            scene.addRow("velocity", {0, 0, 0, 3, 2, 1}, i);
         }
         scene.link();
         scene.effects.clear();
         Run run(scene, {.integrator = integrator, .instructions = instructions});
         QVERIFY2(run.status == DIATOM_OK, text(run).c_str());
         const double before = run.balance();
         const double step = 0.1 * run.estimate.stable_step;
         QCOMPARE(run.to(1000 * step, step), DIATOM_OK);
         const double drift = std::abs(run.balance() / before - 1);
         QVERIFY2(drift < 0.01, qPrintable(QString("%1 %2: %3").arg(instructions, integrator).arg(drift)));
      }
}

void SolverBondsSmallTurnsTest::largeTurnsAreToldOnce()
{
   HandScene scene = bar(20, 1e-3, kRubber);
   scene.analysis = "dynamics";
   scene.addRow("force", {0, 0, -1e-4, 0, 0, 0}, 20);
   HandScene linear = small(scene);
   Run all(scene), run(linear);
   for (int i = 1; i <= 3; ++i) {
      QCOMPARE(all.to(0.01 * i), DIATOM_OK);
      QCOMPARE(run.to(0.01 * i), DIATOM_OK);
   }
   QVERIFY2(text(all).find("switched off") == std::string::npos, text(all).c_str());
   const auto first = text(run).find("rotation is switched off");
   QVERIFY2(first != std::string::npos, text(run).c_str());
   QVERIFY(text(run).find("rotation is switched off", first + 1) == std::string::npos);
   QVERIFY2(text(run).find("wrong by up") != std::string::npos, text(run).c_str());
}

void SolverBondsSmallTurnsTest::whatAlwaysTurnsIsRefused()
{
   HandScene scene = small(bar(3, 1e-3, kRubber));
   scene.analysis = "dynamics";
   Run implicit(scene, {.integrator = "implicit"});
   QCOMPARE(implicit.status, DIATOM_UNSUPPORTED);
   QVERIFY2(text(implicit).find("rotation") != std::string::npos, text(implicit).c_str());
   HandScene coupled = scene;
   coupled.materials[0].property["poisson_coupling"] = 1;
   coupled.effects.push_back("poisson");
   Run poisson(coupled);
   QCOMPARE(poisson.status, DIATOM_UNSUPPORTED);
   QVERIFY2(text(poisson).find("rotation") != std::string::npos, text(poisson).c_str());
}

QTEST_APPLESS_MAIN(SolverBondsSmallTurnsTest)
#include "solver_bonds_small_turns_test.moc"
