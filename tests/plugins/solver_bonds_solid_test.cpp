// Couplings between the strains of a cell: derivatives, balances, damping, stable step and refusals. What
// they are worth beside solids is in solver_bonds_solid_reference_test.cpp.
#include "plugins/solver_bonds_solid.h"

#include <random>

using namespace bonds;
using namespace diatom::test;

namespace {

class Random
{
public:
   Vector vector(std::int64_t size, double scale)
   {
      Vector out(size);
      for (double &v : out)
         v = scale * m_uniform(m_engine);
      return out;
   }

private:
   std::mt19937 m_engine{20250203};
   std::uniform_real_distribution<double> m_uniform{-1, 1};
};

/// A block with a notch and a bar, of two solids and a bond, so that every kind of neighbourhood occurs.
/// Dimensions of 1 m and moduli near 1 keep the figures readable.
HandScene medley(double dampingRatio = 0)
{
   HandScene scene(1);
   auto material = [&](double nu, double e, double model, double density) {
      auto m = solidMaterial(nu, e, dampingRatio, model);
      m["density"] = density;
      scene.addMaterial(m);
   };
   material(0.3, 1, 2, 1);
   material(0.45, 3, 2, 5);
   material(0.3, 2, 0, 0.01);
   for (int x = 0; x < 4; ++x)
      for (int y = 0; y < 3; ++y)
         for (int z = 0; z < 2; ++z)
            if (x != 1 || y != 1)
               scene.addCell(x, y, z, x < 2 ? 0 : y < 2 ? 1 : 2);
   scene.addCell(4, 0, 0, 2);
   scene.addCell(5, 0, 0, 0);
   scene.link();
   scene.effects = {"rotation", "solid"};
   if (dampingRatio > 0)
      scene.effects.push_back("damping");
   return scene;
}

/// Every cell moved by up to `strain` and turned by up to `turn` (rad), the whole turned by 2 rad.
State stirred(const SolidModel &model, double strain, double turn)
{
   Random random;
   State s(model.assembly.cells);
   const Quat whole = exponential({1.2, -0.9, 1.3});
   const Mat3 r = matrix(whole);
   Vector by = random.vector(6 * s.n, strain);
   for (std::int64_t i = 0; i < s.n; ++i) {
      const Vec3 at{model.assembly.rest[0][i], model.assembly.rest[1][i], model.assembly.rest[2][i]};
      const Vec3 moved = r * at - at;
      s.displacement(0)[i] = moved.x + by[6 * i];
      s.displacement(1)[i] = moved.y + by[6 * i + 1];
      s.displacement(2)[i] = moved.z + by[6 * i + 2];
      s.setTurn(i, exponential((turn / strain) * Vec3{by[6 * i + 3], by[6 * i + 4], by[6 * i + 5]}) * whole);
   }
   return s;
}

double scaleOf(const Vector &v) { return v.cwiseAbs().maxCoeff(); }

/// Fourth-order difference quotient of f along `direction`.
template<typename F>
auto quotient(const State &s, const Vector &direction, F f)
{
   const double h = 2e-3;
   const auto at = [&](double n) {
      State moved = s;
      SolidModel::move(moved, n * h * direction);
      return f(moved);
   };
   decltype(f(s)) out = (1 / (12 * h)) * (8.0 * (at(1) - at(-1)) - (at(2) - at(-2)));
   return out;
}

} // namespace

class SolverBondsSolidTest : public QObject
{
   Q_OBJECT
private slots:
   void aCellWithAllNeighboursHoldsTheIsotropicLawLessItsBonds();
   void freeFacesAreInPlaneStress();
   void forcesAreTheGradientOfTheEnergy();
   void stiffnessIsTheDerivativeOfTheForces();
   void dampingIsTheDerivativeByTheRates();
   void forcesAndMomentsBalance();
   void rigidMotionStrainsNothing();
   void forcesTurnWithTheWhole();
   void dampingOnlyTakesEnergy();
};

/// Inverting E C^-1 = (1 + nu) 1 - nu ones by hand for nu = 0.25: C = E (1.2 on, 0.4 off the diagonal).
void SolverBondsSolidTest::aCellWithAllNeighboursHoldsTheIsotropicLawLessItsBonds()
{
   const Symmetric k = poissonStiffness(10, 0.25, 2, {1, 1, 1});
   for (std::size_t i = 0; i < 3; ++i) {
      QVERIFY(std::abs(k[i] - 20 * 0.2) < 1e-13);
      QVERIFY(std::abs(k[3 + i] - 20 * 0.4) < 1e-13);
   }
}

/// Plane stress: E/(1 - nu^2) (1 on, nu off the diagonal). With one direction left the law is E: nothing.
void SolverBondsSolidTest::freeFacesAreInPlaneStress()
{
   const double nu = 0.3, plane = 10 / (1 - nu * nu);
   const Symmetric plate = poissonStiffness(10, nu, 1, {1, 1, 0});
   QVERIFY(std::abs(plate[0] - (plane - 10)) < 1e-13 && std::abs(plate[5] - plane * nu) < 1e-13);
   QCOMPARE(plate[2], 0.0);
   QVERIFY(std::abs(plate[3]) + std::abs(plate[4]) == 0);
   for (const double v : poissonStiffness(10, nu, 1, {1, 0, 0}))
      QVERIFY(std::abs(v) < 1e-14);
   const Symmetric half = poissonStiffness(10, nu, 1, {1, 1, 0.5}),
                   whole = poissonStiffness(10, nu, 1, {1, 1, 1});
   for (std::size_t i = 0; i < 6; ++i)
      QVERIFY(std::abs(half[i] - 0.5 * (plate[i] + whole[i])) < 1e-13);
}

/// Truncation h^4 and rounding 1e-16/h of the quotient: 1e-9 of the largest force.
void SolverBondsSolidTest::forcesAreTheGradientOfTheEnergy()
{
   HandScene scene = medley();
   const SolidModel model(scene);
   QCOMPARE(model.couplings.size(), std::size_t{1});
   const State s = stirred(model, 0.2, 0.8);
   const Vector forces = model.couplingForces(s);
   for (Eigen::Index i = 0; i < forces.size(); ++i) {
      const double slope = quotient(s, Vector::Unit(forces.size(), i),
                                    [&](const State &at) { return model.couplingEnergy(at); });
      QVERIFY2(std::abs(slope + forces[i]) < 1e-9 * scaleOf(forces),
               qPrintable(QString("%1: %2 %3").arg(i).arg(slope).arg(forces[i])));
   }
}

/// The same; also at rest with strains of 1e-9 m, where the tangent is that of a linear solid.
void SolverBondsSolidTest::stiffnessIsTheDerivativeOfTheForces()
{
   HandScene scene = medley();
   const SolidModel model(scene);
   Random random;
   for (const double size : {0.2, 1e-9}) {
      const State s = stirred(model, size, 4 * size);
      const Eigen::SparseMatrix<double> k = model.couplingStiffness(s);
      for (int n = 0; n < 20; ++n) {
         const Vector direction = random.vector(k.cols(), 1), exact = -(k * direction);
         const Vector measured =
             quotient(s, direction, [&](const State &at) { return model.couplingForces(at); });
         QVERIFY2(scaleOf(measured - exact) < 1e-8 * scaleOf(exact),
                  qPrintable(QString::number(scaleOf(measured - exact) / scaleOf(exact))));
      }
   }
}

/// Forces are linear in the rates: a plain difference is exact to rounding.
void SolverBondsSolidTest::dampingIsTheDerivativeByTheRates()
{
   HandScene scene = medley(0.1);
   const SolidModel model(scene);
   Random random;
   State s = stirred(model, 0.2, 0.8);
   const Vector still = model.couplingForces(s), rates = random.vector(6 * s.n, 1);
   Vector exact = Vector::Zero(6 * s.n);
   for (const auto &coupling : model.couplings)
      coupling->addDamping(s, [&](std::int64_t row, std::int64_t column, const double *block) {
         for (int k = 0; k < 36; ++k)
            exact[6 * row + k / 6] -= block[k] * rates[6 * column + k % 6];
      });
   SolidModel::setRates(s, rates);
   const Vector measured = model.couplingForces(s) - still;
   QVERIFY(scaleOf(exact) > 1e-3);
   QVERIFY(scaleOf(measured - exact) < 1e-13 * scaleOf(still));
}

/// Sums of 24 cells and moments about the origin, 6 m away: rounding.
void SolverBondsSolidTest::forcesAndMomentsBalance()
{
   HandScene scene = medley(0.1);
   const SolidModel model(scene);
   State s = stirred(model, 0.3, 1);
   SolidModel::setRates(s, Random().vector(6 * s.n, 1));
   const Vector f = model.couplingForces(s);
   Vec3 force, moment;
   for (std::int64_t i = 0; i < s.n; ++i) {
      const Vec3 at = Vec3{model.assembly.rest[0][i], model.assembly.rest[1][i], model.assembly.rest[2][i]} +
                      s.displacementOf(i);
      const Vec3 own{f[6 * i], f[6 * i + 1], f[6 * i + 2]};
      force = force + own;
      moment = moment + Vec3{f[6 * i + 3], f[6 * i + 4], f[6 * i + 5]} + cross(at, own);
   }
   QVERIFY2(norm(force) < 1e-14 * scaleOf(f), qPrintable(QString::number(norm(force) / scaleOf(f))));
   QVERIFY2(norm(moment) < 1e-13 * scaleOf(f), qPrintable(QString::number(norm(moment) / scaleOf(f))));
}

/// Turned as a whole by 2 rad and spinning: nothing but the rounding of places 6 m from the origin.
void SolverBondsSolidTest::rigidMotionStrainsNothing()
{
   HandScene scene = medley(0.1);
   const SolidModel model(scene);
   State s = stirred(model, 1e-300, 0);
   const Vec3 spin{0.3, -2, 1};
   for (std::int64_t i = 0; i < s.n; ++i) {
      const Vec3 at = Vec3{model.assembly.rest[0][i], model.assembly.rest[1][i], model.assembly.rest[2][i]} +
                      s.displacementOf(i);
      const Vec3 v = cross(spin, at);
      const double rates[6] = {v.x, v.y, v.z, spin.x, spin.y, spin.z};
      for (int k = 0; k < 6; ++k)
         s.column(7 + k)[i] = rates[k];
   }
   double power = 1;
   QVERIFY(scaleOf(model.couplingForces(s, nullptr, &power)) < 1e-13);
   QVERIFY(std::abs(power) < 1e-26);
   QVERIFY(std::abs(model.couplingEnergy(s)) < 1e-26);
}

/// A deformed body turned further by a quarter and more: the same forces, turned; rounding.
void SolverBondsSolidTest::forcesTurnWithTheWhole()
{
   HandScene scene = medley();
   const SolidModel model(scene);
   const State before = stirred(model, 0.2, 0.8);
   State after = before;
   const Quat turn = exponential({-0.4, 2.1, 0.9});
   const Mat3 r = matrix(turn);
   for (std::int64_t i = 0; i < before.n; ++i) {
      const Vec3 at{model.assembly.rest[0][i], model.assembly.rest[1][i], model.assembly.rest[2][i]};
      const Vec3 now = r * (at + before.displacementOf(i)) - at;
      after.displacement(0)[i] = now.x;
      after.displacement(1)[i] = now.y;
      after.displacement(2)[i] = now.z;
      after.setTurn(i, turn * before.turnOf(i));
   }
   const Vector f = model.couplingForces(before), g = model.couplingForces(after);
   for (std::int64_t i = 0; i < 2 * before.n; ++i) {
      const Vec3 turned = r * Vec3{f[3 * i], f[3 * i + 1], f[3 * i + 2]};
      QVERIFY(norm(turned - Vec3{g[3 * i], g[3 * i + 1], g[3 * i + 2]}) < 1e-13 * scaleOf(f));
   }
}

/// Bonds and couplings together lose energy whatever the rates; the coupling alone may give some back.
/// Densities differ by 500, so that unlike bonds of one cell are damped unlike.
void SolverBondsSolidTest::dampingOnlyTakesEnergy()
{
   HandScene scene = medley(0.3);
   const SolidModel model(scene);
   const Assembly &assembly = model.assembly;
   State s(assembly.cells);
   Matrix loss = Matrix::Zero(6 * s.n, 6 * s.n);
   for (const auto &coupling : model.couplings)
      coupling->addDamping(s, [&](std::int64_t row, std::int64_t column, const double *block) {
         for (int k = 0; k < 36; ++k)
            loss(6 * row + k / 6, 6 * column + k % 6) += block[k];
      });
   for (std::int64_t i = 0; i < assembly.links; ++i) {
      const int axis = assembly.axisOf(i);
      Vector strain = Vector::Zero(6 * s.n); // axial rate of the bond; all else only adds to the loss
      strain[6 * assembly.b[i] + axis] = 1;
      strain[6 * assembly.a[i] + axis] = -1;
      loss += assembly.constants[i].d[0] * strain * strain.transpose();
   }
   const Vector values = Eigen::SelfAdjointEigenSolver<Matrix>(loss, Eigen::EigenvaluesOnly).eigenvalues();
   QVERIFY2(values[0] > -1e-13 * values[values.size() - 1],
            qPrintable(QString("%1 %2").arg(values[0]).arg(values[values.size() - 1])));
}

QTEST_APPLESS_MAIN(SolverBondsSolidTest)
#include "solver_bonds_solid_test.moc"
