// Solids in motion: threads, stable step, energy, and scenes that cannot be solid.
#include "plugins/solver_bonds_solid.h"

#include <cstring>

using namespace bonds;
using namespace diatom::test;

class SolverBondsSolidMotionTest : public QObject
{
   Q_OBJECT
private slots:
   void aBitIsTheSameOnAnyNumberOfThreads();
   void stableStepIsABoundAndNotAFarOne_data();
   void stableStepIsABoundAndNotAFarOne();
   void motionKeepsEnergyAndMomentum();
   void dampedAndDrivenMotionBalancesItsEnergy();
   void bondsAloneAreUntouched();
   void scenesThatCannotBeSolidAreRefused();
};

/// 18^3 cells are enough for threads to be used.
void SolverBondsSolidMotionTest::aBitIsTheSameOnAnyNumberOfThreads()
{
   std::vector<double> first;
   for (const int threads : {1, 2, 3}) {
      HandScene scene(0.01);
      scene.addMaterial(solidMaterial(0.3, 5e6, 0.05));
      scene.addBlock(18, 18, 18);
      scene.link();
      scene.effects = {"rotation", "solid", "damping", "loads"};
      scene.addRow("force", {1, 0.3, 0.2, 0.01, 0, 0}, 0);
      Run run(scene, {"verlet"}, threads);
      QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
      QCOMPARE(run.to(1, 0, 10), DIATOM_OK);
      std::vector<double> all;
      for (const char *name : {"position", "rotation", "velocity", "energy", "momentum"})
         for (const double v : run.read(name))
            all.push_back(v);
      if (first.empty())
         first = all;
      QVERIFY(std::memcmp(first.data(), all.data(), all.size() * sizeof(double)) == 0);
   }
}

void SolverBondsSolidMotionTest::stableStepIsABoundAndNotAFarOne_data()
{
   QTest::addColumn<double>("nu");
   QTest::addColumn<double>("contrast");
   for (const double nu : {0.0, 0.3, 0.45, -0.5})
      for (const double contrast : {1.0, 1e4})
         QTest::newRow(qPrintable(QString("nu %1, contrast %2").arg(nu).arg(contrast))) << nu << contrast;
}

/// Against the largest eigenvalue of the assembled block. The bound of bonds alone reaches 0.7 to 0.9 of the
/// true limit of such blocks; half is asked, so that no one pays more than twice.
void SolverBondsSolidMotionTest::stableStepIsABoundAndNotAFarOne()
{
   QFETCH(double, nu);
   QFETCH(double, contrast);
   HandScene scene(0.01);
   scene.addMaterial(solidMaterial(nu));
   scene.addMaterial(solidMaterial(nu, 5e6 * contrast));
   for (int x = 0; x < 4; ++x)
      for (int y = 0; y < 4; ++y)
         for (int z = 0; z < 3; ++z)
            scene.addCell(x, y, z, (x + y + z) % 3 == 0);
   scene.link();
   scene.effects = {"rotation", "solid"};
   const SolidModel model(scene);
   const Vector values = model.eigenvalues(model.state);
   const double limit = 2 / std::sqrt(values[values.size() - 1]);
   const double step = stableStep(model.assembly, {}, model.couplings).step;
   qInfo("stable step bound / true limit: %.3f", step / limit);
   QVERIFY(step <= limit * (1 + 1e-12));
   QVERIFY(step > 0.5 * limit);
   QVERIFY2(values[0] > -1e-9 * values[values.size() - 1], "the block at rest must be stable");
}

/// A free block of rubber struck at a corner, at half its stable step: a symplectic step keeps a nearby
/// energy (the error of 2e-3 is the square of step times frequency, and must not grow), momenta to rounding.
void SolverBondsSolidMotionTest::motionKeepsEnergyAndMomentum()
{
   HandScene scene(0.01);
   scene.addMaterial(solidMaterial(0.45));
   scene.addBlock(4, 3, 3);
   scene.link();
   scene.effects = {"rotation", "solid"};
   scene.addRow("velocity", {3, 1, 2, 50, 0, -80}, 0);
   Run run(scene, {"verlet"});
   QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
   const double start = run.balance(), step = 0.5 * run.estimate.stable_step;
   const auto momentum = run.read("momentum");
   double worst = 0, early = 0;
   for (int n = 1; n <= 40; ++n) {
      QCOMPARE(run.to(n * 250 * step, step), DIATOM_OK);
      worst = std::max(worst, std::abs(run.balance() / start - 1));
      if (n == 4)
         early = worst;
   }
   const auto after = run.read("momentum");
   qInfo("energy error %.1e after 1000 steps, %.1e after 10000", early, worst);
   QVERIFY(worst < 5e-2);
   QVERIFY(worst < 2 * early);
   for (std::size_t k = 0; k < 3; ++k) { // 10000 steps of rounding
      QVERIFY(std::abs(after[k] - momentum[k]) < 1e-12 * std::abs(momentum[0]));
      QVERIFY(std::abs(after[3 + k] - momentum[3 + k]) < 1e-11 * std::abs(momentum[3]));
   }
}

/// Stored plus lost minus supplied stays what it was, with the error of the step: 0.5 % at half the limit and
/// a quarter of that at half the step.
void SolverBondsSolidMotionTest::dampedAndDrivenMotionBalancesItsEnergy()
{
   double error[2]{};
   for (int half = 0; half < 2; ++half) {
      HandScene scene(0.01);
      scene.addMaterial(solidMaterial(0.4, 5e6, 0.05));
      scene.addBlock(5, 2, 2);
      scene.link();
      scene.effects = {"rotation", "solid", "damping", "actuation"};
      scene.addRow("source", {0, 200, 0, 0.5, 0, 1}, 0);
      for (int cell = 0; cell < 10; ++cell)
         scene.addRow("actuator", {0, 0, 0.2, 0, -1}, cell);
      Run run(scene, {"rk4"});
      QVERIFY2(run.status == DIATOM_OK, run.host.said.c_str());
      QCOMPARE(run.to(0.004, 0.5 * run.estimate.stable_step / (1 + half)), DIATOM_OK);
      const auto energy = run.read("energy");
      error[half] = std::abs(run.balance()) / energy[5];
      qInfo("supplied %.3e J, lost %.3e J, missing %.1e of it", energy[5], energy[4], error[half]);
      QVERIFY(energy[5] > 0 && energy[4] > 0);
   }
   QVERIFY(error[0] < 2e-2);
   QVERIFY(error[1] < 0.5 * error[0]);
}

/// Without the effect, or without a Poisson ratio, there is no coupling and not a bit changes.
void SolverBondsSolidMotionTest::bondsAloneAreUntouched()
{
   const auto answer = [](std::map<std::string, double> material, std::vector<std::string> effects) {
      HandScene scene(0.01);
      scene.addMaterial(std::move(material));
      scene.addBlock(3, 3, 3);
      scene.link();
      scene.effects = std::move(effects);
      scene.addRow("velocity", {1, 0, 0, 0, 20, 0}, 0);
      Run run(scene);
      run.to(1, 1e-5, 200);
      return run.read("position");
   };
   auto plain = solidMaterial(0.3, 5e6, 0, 0);
   const auto bond = answer(plain, {"rotation"});
   plain.erase("cell_model");
   QVERIFY(bond == answer(plain, {"rotation"}));
   QVERIFY(bond == answer(solidMaterial(0.3), {"rotation"})); // the effect "solid" is off
   QVERIFY(bond != answer(solidMaterial(0.3), {"rotation", "solid"}));
   plain["poisson_coupling"] = 0;
   QVERIFY(bond == answer(plain, {"rotation", "poisson"}));
   plain["poisson_coupling"] = 1;
   QVERIFY(bond != answer(plain, {"rotation", "poisson"}));
   QVERIFY(bond == answer(plain, {"rotation"}));
   QVERIFY(answer(solidMaterial(0, 5e6, 0, 1), {"rotation"}) ==
           answer(solidMaterial(0), {"rotation", "solid"}));
}

void SolverBondsSolidMotionTest::scenesThatCannotBeSolidAreRefused()
{
   const auto refusal = [](std::map<std::string, double> material, double gap = 0) {
      HandScene scene(0.01);
      scene.addMaterial(std::move(material));
      scene.addBlock(2, 2, 2);
      scene.link();
      scene.position[0] -= gap;
      scene.effects = {"rotation", "solid"};
      Run run(scene);
      return run.status == DIATOM_OK ? std::string() : run.host.said;
   };
   QCOMPARE(refusal(solidMaterial(0.3)), std::string());
   const std::string apart = refusal(solidMaterial(0.3), 0.001);
   QVERIFY2(apart.find("does not fill a lattice of boxes") != std::string::npos, apart.c_str());
   const std::string half = refusal(solidMaterial(0.5));
   QVERIFY2(half.find("below 0.5") != std::string::npos, half.c_str());
   auto own = solidMaterial(0.3);
   own["axial_x"] = 5e4;
   const std::string constants = refusal(own);
   QVERIFY2(constants.find("must not have bond constants of its own") != std::string::npos,
            constants.c_str());
   const std::string unknown = refusal(solidMaterial(0.3, 5e6, 0, 3));
   QVERIFY2(unknown.find("cell model") != std::string::npos, unknown.c_str());
}

QTEST_APPLESS_MAIN(SolverBondsSolidMotionTest)
#include "solver_bonds_solid_motion_test.moc"
