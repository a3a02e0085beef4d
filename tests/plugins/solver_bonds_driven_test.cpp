// Motion in time that curves lead and that starts from poses, against exact solutions.
#include "solver_bonds_equilibrium_scene.h"

using namespace diatom::test;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// A bar along x that nothing holds yet.
HandScene looseBar(int cells, double pitch, const Props &material)
{
   HandScene scene(pitch);
   scene.addMaterial(material);
   scene.addBlock(cells, 1, 1);
   scene.link();
   return scene;
}

/// Drives a degree of freedom through points (time, value).
void lead(HandScene &scene, int cell, int freedom, const std::vector<std::array<double, 2>> &points)
{
   const auto curve = static_cast<std::int64_t>(scene.channels["driven"].where.size());
   scene.addRow("driven", {double(freedom), double(curve)}, cell);
   for (const auto &[time, value] : points)
      scene.addRow("curve", {time, value}, curve);
}

void integrators()
{
   QTest::addColumn<QString>("integrator");
   QTest::addColumn<double>("bound");
}

} // namespace

class SolverBondsDrivenTest : public QObject
{
   Q_OBJECT
private slots:
   void aDrivenOscillatorMovesAsItsSolutionSays_data();
   void aDrivenOscillatorMovesAsItsSolutionSays();
   void aFullTurnCarriesABarAround_data();
   void aFullTurnCarriesABarAround();
   void aDrivenBoxSpinsAboutASkewAxis();
   void curvesAreMetExactlyAndTheirWorkIsCounted_data();
   void curvesAreMetExactlyAndTheirWorkIsCounted();
   void aStretchedStartOscillates_data();
   void aStretchedStartOscillates();
   void startsFollowPosesAndCurves();
   void energyOfSemiImplicitEulerIsSecondOrder();
};

void SolverBondsDrivenTest::aDrivenOscillatorMovesAsItsSolutionSays_data()
{
   integrators();
   // The phase errors of ten radians at 0.02 rad a step: 0.02^2/24 * 10 = 2e-4 for Verlet; Euler's velocities
   // lag half a step, 1e-2; 10 * 0.02^4/120 for Runge-Kutta.
   QTest::newRow("semi-implicit") << "semi_implicit" << 2e-2;
   QTest::newRow("verlet") << "verlet" << 3e-4;
   QTest::newRow("rk4") << "rk4" << 3e-8;
}

/// One cell on a spring whose other end moves off at a constant speed V: x = V t - V/w sin(w t), and the
/// drive pushes with k V/w sin(w t).
void SolverBondsDrivenTest::aDrivenOscillatorMovesAsItsSolutionSays()
{
   QFETCH(QString, integrator);
   QFETCH(double, bound);
   const double l = 1e-2, speed = 1e-2;
   HandScene scene = looseBar(2, l, kRubber);
   scene.fix(0, 0b111110);
   scene.fix(1, 0b111110);
   lead(scene, 0, 0, {{0, 0}, {10, 10 * speed}});
   Run run(scene, {.integrator = integrator.toStdString()});
   QVERIFY2(run.status == DIATOM_OK, text(run).c_str());
   const double k = 1e6 * l, w = std::sqrt(k / (1000 * l * l * l)), size = speed / w;
   const double before = run.balance();
   for (int i = 1; i <= 10; ++i) {
      const double time = i / w;
      QCOMPARE(run.to(time, 0.02 / w), DIATOM_OK);
      const auto p = run.read("position");
      QCOMPARE(p[0], speed * time);
      const double x = p[3] - l, exact = speed * time - size * std::sin(w * time);
      QVERIFY2(std::abs(x - exact) < bound * size, qPrintable(QString::number((x - exact) / size)));
      const double push = k * size * std::sin(w * time);
      QVERIFY(std::abs(run.read("reaction")[0] - push) < bound * k * size);
      QVERIFY(std::abs(run.read("internal_force")[0] + push) < bound * k * size);
      // Both cells have at most twice the drive's energy of motion.
      QVERIFY(std::abs(run.balance() - before) < bound * 1000 * l * l * l * speed * speed);
   }
}

void SolverBondsDrivenTest::aFullTurnCarriesABarAround_data()
{
   integrators();
   QTest::newRow("semi-implicit") << "semi_implicit" << 2e-3;
   QTest::newRow("verlet") << "verlet" << 1e-4;
   QTest::newRow("rk4") << "rk4" << 1e-4;
}

/// A damped bar whose first cell turns by 360 degrees about z in a second. The sudden start sets it swinging
/// by speed over frequency, 0.22 m/s / 260 rad/s = 2 % of its length, which dies out with the damping; what
/// stays is what its own inertia asks for, (w_turn/w_bar)^2 = 6e-4.
void SolverBondsDrivenTest::aFullTurnCarriesABarAround()
{
   QFETCH(QString, integrator);
   QFETCH(double, bound);
   Props material = kRubber;
   material["damping_ratio"] = 0.5;
   const double l = 1e-2;
   const int n = 4;
   HandScene scene = looseBar(n, l, material);
   scene.effects.push_back("damping");
   scene.fix(0, 0b011111);
   lead(scene, 0, 5, {{0, 0}, {1, 2 * kPi}});
   Run run(scene, {.integrator = integrator.toStdString()});
   QVERIFY2(run.status == DIATOM_OK, text(run).c_str());
   double most = 0, in = 0;
   const double before = run.balance();
   for (int eighth = 1; eighth <= 8; ++eighth) {
      QCOMPARE(run.to(eighth / 8.0), DIATOM_OK);
      const auto p = run.read("position"), q = run.read("rotation");
      const double angle = 2 * kPi * eighth / 8, near = (eighth < 5 ? 2e-2 : 2e-3) * n * l;
      for (int i = 0; i < n; ++i) {
         QVERIFY(std::abs(p[3 * i] - i * l * std::cos(angle)) < near);
         QVERIFY(std::abs(p[3 * i + 1] - i * l * std::sin(angle)) < near);
      }
      QVERIFY(std::abs(q[0] - std::cos(angle / 2)) < 1e-12); // thousands of roundings
      QVERIFY(std::abs(q[3] - std::sin(angle / 2)) < 1e-12);
      const auto e = run.read("energy");
      in = std::max({in, e[0], e[5]});
      most = std::max(most, std::abs(run.balance() - before));
   }
   qInfo("%s: balance off by %.2e of %.2e J", qPrintable(integrator), most / in, in);
   QVERIFY(in > 0);
   QVERIFY2(most < bound * in, qPrintable(QString::number(most / in)));
}

/// A lone flat box led about an axis that is none of its own: the drive's moment is w x I w, and its work the
/// change of w . I w / 2, which the turning box takes and gives.
void SolverBondsDrivenTest::aDrivenBoxSpinsAboutASkewAxis()
{
   HandScene scene(1e-2);
   scene.addMaterial(kRubber);
   scene.addCell(0, 0, 0);
   scene.extent = {1e-2, 2e-2, 4e-3};
   scene.fix(0, 0b000111);
   const double w[3] = {2, 1, 3};
   for (int k = 0; k < 3; ++k)
      lead(scene, 0, 3 + k, {{0, 0}, {1, w[k]}});
   for (const char *integrator : {"semi_implicit", "verlet", "rk4"}) {
      Run run(scene, {.integrator = integrator});
      QVERIFY2(run.status == DIATOM_OK, text(run).c_str());
      const double before = run.balance();
      QCOMPARE(run.to(0.7), DIATOM_OK);
      const double size = std::sqrt(14.0), half = 0.35 * size;
      const auto q = run.read("rotation");
      QVERIFY(std::abs(q[0] - std::cos(half)) < 1e-12);
      for (int k = 0; k < 3; ++k)
         QVERIFY(std::abs(q[1 + k] - w[k] / size * std::sin(half)) < 1e-12);
      QVERIFY(std::abs(run.balance() - before) < 1e-12 * run.read("energy")[0]);
      // Own frame: w x I w turned along. About w itself there is no moment.
      const auto r = run.read("reaction");
      QVERIFY(std::abs(w[0] * r[3] + w[1] * r[4] + w[2] * r[5]) < 1e-12 * std::abs(w[0] * r[3]));
   }
}

void SolverBondsDrivenTest::curvesAreMetExactlyAndTheirWorkIsCounted_data()
{
   integrators();
   QTest::newRow("semi-implicit") << "semi_implicit" << 1e-3;
   QTest::newRow("verlet") << "verlet" << 1e-3;
   QTest::newRow("rk4") << "rk4" << 1e-3;
}

/// To and fro with corners within the steps, a twist at the other end, gravity and drag: places to the last
/// bit, energy to second order of a step that is a tenth of the limit.
void SolverBondsDrivenTest::curvesAreMetExactlyAndTheirWorkIsCounted()
{
   QFETCH(QString, integrator);
   QFETCH(double, bound);
   HandScene scene = looseBar(6, 1e-2, kRubber);
   for (const char *effect : {"gravity", "drag"})
      scene.effects.push_back(effect);
   scene.addRow("gravity", {0, 0, -9.81});
   scene.addRow("drag", {5});
   scene.fix(0, 0b111001);
   lead(scene, 0, 1, {{0, 0}, {0.0311, 4e-3}, {0.0713, -2e-3}, {0.09, 1e-3}});
   lead(scene, 0, 2, {{0, 0}, {0.05, 3e-3}});
   lead(scene, 5, 3, {{0.01, 0}, {0.06, 0.5}});
   Run run(scene, {.integrator = integrator.toStdString()});
   QVERIFY2(run.status == DIATOM_OK, text(run).c_str());
   const double before = run.balance();
   double most = 0, in = 0;
   for (int i = 1; i <= 100; ++i) {
      const double time = i * 1e-3;
      QCOMPARE(run.to(time, 0.1 * run.estimate.stable_step), DIATOM_OK);
      const auto p = run.read("position");
      const double y = time < 0.0311   ? 4e-3 * (time / 0.0311)
                       : time < 0.0713 ? 4e-3 - 6e-3 * (time - 0.0311) / (0.0713 - 0.0311)
                       : time < 0.09   ? -2e-3 + 3e-3 * (time - 0.0713) / (0.09 - 0.0713)
                                       : 1e-3;
      QVERIFY(std::abs(p[1] - y) < 1e-17);
      QVERIFY(std::abs(p[2] - 3e-3 * std::min(1.0, time / 0.05)) < 1e-17);
      const auto e = run.read("energy");
      in = std::max({in, std::abs(e[5]), e[0], e[1]});
      most = std::max(most, std::abs(run.balance() - before));
   }
   qInfo("%s: balance off by %.2e of %.2e J", qPrintable(integrator), most / in, in);
   QVERIFY2(most < bound * in, qPrintable(QString::number(most / in)));
}

void SolverBondsDrivenTest::aStretchedStartOscillates_data()
{
   integrators();
   QTest::newRow("semi-implicit") << "semi_implicit" << 2e-2; // as above, of 20 radians
   QTest::newRow("verlet") << "verlet" << 6e-4;
   QTest::newRow("rk4") << "rk4" << 6e-8;
}

/// Two free cells pulled apart by 2a: each swings as a cos(w t) with w^2 = 2 k / m; the energy is that of the
/// start.
void SolverBondsDrivenTest::aStretchedStartOscillates()
{
   QFETCH(QString, integrator);
   QFETCH(double, bound);
   const double l = 1e-2, a = 1e-3;
   HandScene scene = looseBar(2, l, kRubber);
   scene.addRow("pose", {-a, 0, 0, 0, 0, 0}, 0);
   scene.addRow("pose", {a, 0, 0, 0, 0, 0}, 1);
   Run run(scene, {.integrator = integrator.toStdString()});
   QVERIFY2(run.status == DIATOM_OK, text(run).c_str());
   const double k = 1e6 * l, w = std::sqrt(2 * k / (1000 * l * l * l)), start = 0.5 * k * 4 * a * a;
   QVERIFY(std::abs(run.read("energy")[1] / start - 1) < 1e-12);
   for (int i = 1; i <= 20; ++i) {
      QCOMPARE(run.to(i / w, 0.02 / w), DIATOM_OK);
      const auto p = run.read("position");
      QVERIFY(std::abs(p[3] - l - a * std::cos(i)) < bound * a);
      QVERIFY(std::abs(p[0] + a * std::cos(i)) < bound * a);
      QVERIFY(std::abs(run.stored() / start - 1) < bound);
      QCOMPARE(run.read("energy")[5], 0.0);
   }
}

void SolverBondsDrivenTest::startsFollowPosesAndCurves()
{
   HandScene scene = looseBar(2, 1e-2, kRubber);
   scene.addRow("pose", {1e-3, 2e-3, 3e-3, 0.3, -0.2, 0.6}, 0);
   scene.addRow("pose", {4e-3, 0, 0, 0, 0, 0.5}, 1);
   lead(scene, 1, 1, {{0, 7e-3}});
   lead(scene, 1, 5, {{0, 0.9}});
   Run run(scene);
   QVERIFY2(run.status == DIATOM_OK, text(run).c_str());
   const auto p = run.read("position"), q = run.read("rotation");
   QCOMPARE(p[0], 1e-3);
   QCOMPARE(p[2], 3e-3);
   QCOMPARE(p[3], 1e-2 + 4e-3);
   QCOMPARE(p[4], 7e-3); // its curve, not its pose
   QVERIFY(std::abs(q[0] - std::cos(0.35)) < 1e-15);
   QVERIFY(std::abs(q[1] - 0.3 / 0.7 * std::sin(0.35)) < 1e-15);
   QVERIFY(std::abs(q[7] - std::sin(0.45)) < 1e-15);
}

/// The same swing at a step and at half of it: the energies of Euler's method differ from the exact one by a
/// quarter as much.
void SolverBondsDrivenTest::energyOfSemiImplicitEulerIsSecondOrder()
{
   const double l = 1e-2, a = 1e-3;
   HandScene scene = looseBar(2, l, kRubber);
   scene.addRow("pose", {a, 0, 0, 0, 0, 0}, 1);
   const double w = std::sqrt(2 * 1e6 * l / (1000 * l * l * l));
   double off[2];
   for (int half = 0; half < 2; ++half) {
      Run run(scene);
      QVERIFY2(run.status == DIATOM_OK, text(run).c_str());
      const double start = run.stored();
      off[half] = 0;
      for (int i = 1; i <= 40; ++i) {
         QCOMPARE(run.to(0.2 * i / w, (half ? 0.05 : 0.1) / w), DIATOM_OK);
         off[half] = std::max(off[half], std::abs(run.stored() / start - 1));
      }
   }
   qInfo("off by %.2e and %.2e", off[0], off[1]);
   QVERIFY(off[0] < 0.01 && off[1] > 0);
   QVERIFY2(std::abs(off[0] / off[1] - 4) < 0.4, qPrintable(QString::number(off[0] / off[1])));
}

QTEST_APPLESS_MAIN(SolverBondsDrivenTest)
#include "solver_bonds_driven_test.moc"
