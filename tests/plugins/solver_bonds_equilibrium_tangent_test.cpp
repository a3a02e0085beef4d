// The bond's tangent: against differences of its forces, at any rotation.
#include "model/bond_tangent.h"
#include "support/support.h"

#include <random>

using namespace bonds;

namespace {

struct Sample
{
   BondEnds ends;
   BondConstants k;
   Vec3 stretch, turn;
};

class Random
{
public:
   double number() { return m_uniform(m_engine); }
   Vec3 vector(double size)
   {
      const double x = number(), y = number(), z = number();
      return {size * x, size * y, size * z};
   }
   Vec3 direction()
   {
      Vec3 v = vector(1);
      while (norm(v) < 0.1)
         v = vector(1);
      return (1 / norm(v)) * v;
   }

private:
   std::mt19937 m_engine{20240611};
   std::uniform_real_distribution<double> m_uniform{-1, 1};
};

/// Turned anywhere, bent by `angle`, stretched by up to a half, with rest strains and a stepped coupling.
Sample sample(Random &random, double angle)
{
   Sample s;
   s.ends.length = 1;
   s.ends.qa = exponential(3 * random.direction());
   s.ends.qb = exponential(angle * random.direction()) * s.ends.qa;
   const Vec3 along = matrix(s.ends.qa) * Vec3{1, 0, 0};
   s.ends.displacement = along - Vec3{1, 0, 0} + random.vector(0.5);
   for (std::size_t i = 0; i < 3; ++i) {
      s.k.k[i] = 2 + random.number();
      s.k.c[i] = 1 + 0.5 * random.number();
   }
   s.k.s[0] = s.k.turn[0] = 0.2 * random.number();
   s.k.s[1] = s.k.turn[1] = 0.2 * random.number();
   s.stretch = random.vector(0.1);
   s.turn = random.vector(0.3);
   return s;
}

/// The same for turns that count to first order, of both ends by up to `angle`.
Sample smallSample(Random &random, double angle)
{
   Sample s = sample(random, 0);
   const Vec3 a = random.vector(0.5 * angle), b = random.vector(0.5 * angle);
   s.ends.small = true;
   s.ends.displacement = random.vector(0.5);
   s.ends.qa = {1, a.x, a.y, a.z};
   s.ends.qb = {1, b.x, b.y, b.z};
   return s;
}

EndForces forces(const Sample &s) { return endForces(bondPoint<false>(s.ends, s.k, s.stretch, s.turn)); }

Sample moved(Sample s, Vec3 dv, Vec3 wa, Vec3 wb)
{
   s.ends.displacement = s.ends.displacement + dv;
   const auto turned = [&](Quat q, Vec3 w) {
      return s.ends.small ? Quat{1, q.x + 0.5 * w.x, q.y + 0.5 * w.y, q.z + 0.5 * w.z} : exponential(w) * q;
   };
   s.ends.qa = turned(s.ends.qa, wa);
   s.ends.qb = turned(s.ends.qb, wb);
   return s;
}

EndForces change(const Sample &s, Vec3 dv, Vec3 wa, Vec3 wb)
{
   const BondPoint r = bondPoint<false>(s.ends, s.k, s.stretch, s.turn);
   const auto local = [&](Vec3 v) { return transposed(r.middle, v); };
   const EndForces out = forceChange(r, s.k, local(dv), local(wa), local(wb));
   return {r.middle * out.force, r.middle * out.torqueA, r.middle * out.torqueB};
}

double size(const EndForces &f) { return norm(f.force) + norm(f.torqueA) + norm(f.torqueB); }

/// Fourth-order difference quotient.
EndForces quotient(const Sample &s, Vec3 dv, Vec3 wa, Vec3 wb)
{
   const double h = 1e-3;
   const auto at = [&](double f) { return forces(moved(s, (f * h) * dv, (f * h) * wa, (f * h) * wb)); };
   const EndForces a = at(1), b = at(-1), c = at(2), d = at(-2);
   const auto mix = [&](Vec3 p1, Vec3 m1, Vec3 p2, Vec3 m2) {
      return (1 / (12 * h)) * (8.0 * (p1 - m1) - (p2 - m2));
   };
   return {mix(a.force, b.force, c.force, d.force), mix(a.torqueA, b.torqueA, c.torqueA, d.torqueA),
           mix(a.torqueB, b.torqueB, c.torqueB, d.torqueB)};
}

double difference(const EndForces &a, const EndForces &b)
{
   return norm(a.force - b.force) + norm(a.torqueA - b.torqueA) + norm(a.torqueB - b.torqueB);
}

} // namespace

class SolverBondsEquilibriumTangentTest : public QObject
{
   Q_OBJECT
private slots:
   void forcesAreThoseOfTheKernel();
   void tangentIsTheDerivativeOfTheForces_data();
   void tangentIsTheDerivativeOfTheForces();
   void tangentIsSymmetricButForTheMomentsAtEachEnd();
   void smallStrainsKeepTheirDigits();
};

/// Two evaluations of one formula: they differ by rounding (1e-13) alone.
void SolverBondsEquilibriumTangentTest::forcesAreThoseOfTheKernel()
{
   Random random;
   for (int i = 0; i < 200; ++i) {
      const bool small = i % 2 != 0;
      const Sample s = small ? smallSample(random, 0.015 * i) : sample(random, 0.015 * i);
      const Ends ends{s.ends.displacement + Vec3{1, 0, 0}, s.ends.qa, s.ends.qb, {}, {}, {}, 1};
      BondForces kernel;
      if (small)
         evaluate<false, true, Law::small>(ends, s.k, s.stretch + Vec3{1, 0, 0}, s.turn, kernel);
      else
         evaluate<false, true, Law::exact>(ends, s.k, s.stretch + Vec3{1, 0, 0}, s.turn, kernel);
      const EndForces got = forces(s);
      const double error = difference(got, {kernel.force, kernel.torqueA, kernel.torqueB});
      QVERIFY2(error < 1e-13 * size(got), qPrintable(QString::number(error / size(got))));
   }
}

void SolverBondsEquilibriumTangentTest::tangentIsTheDerivativeOfTheForces_data()
{
   QTest::addColumn<double>("angle");
   QTest::addColumn<bool>("small");
   for (const double angle : {0.0, 1e-9, 1e-4, 0.05, 0.19, 0.21, 0.7, 1.5, 2.5, 3.1})
      QTest::newRow(qPrintable(QString("%1 rad").arg(angle))) << angle << false;
   QTest::newRow("linear in the turns") << 0.7 << true;
}

/// The quotient itself is good to h^4 and to rounding over h: 1e-9 of the stiffness below 3 rad. The half
/// turn at pi is close at 3.1 rad, where the fifth derivatives are large.
void SolverBondsEquilibriumTangentTest::tangentIsTheDerivativeOfTheForces()
{
   QFETCH(double, angle);
   QFETCH(bool, small);
   Random random;
   double worst = 0;
   for (int i = 0; i < 50; ++i) {
      const Sample s = small ? smallSample(random, angle) : sample(random, angle);
      for (int k = 0; k < 4; ++k) {
         const Vec3 dv = random.vector(k == 0 || k == 3 ? 1 : 0),
                    wa = random.vector(k == 1 || k == 3 ? 1 : 0),
                    wb = random.vector(k == 2 || k == 3 ? 1 : 0);
         const EndForces exact = change(s, dv, wa, wb);
         worst = std::max(worst, difference(exact, quotient(s, dv, wa, wb)) / size(exact));
      }
   }
   QVERIFY2(worst < 1e-7, qPrintable(QString::number(worst)));
   qInfo("tangent against differences at %g rad: %.1e", angle, worst);
}

/// Second derivatives of an energy by spins differ in order by the moment: K - K^T = [T]x at each end.
void SolverBondsEquilibriumTangentTest::tangentIsSymmetricButForTheMomentsAtEachEnd()
{
   Random random;
   for (int i = 0; i < 50; ++i) {
      const Sample s = sample(random, 0.06 * i);
      const EndForces at = forces(s);
      const Vec3 d1 = random.vector(1), a1 = random.vector(1), b1 = random.vector(1);
      const Vec3 d2 = random.vector(1), a2 = random.vector(1), b2 = random.vector(1);
      const auto work = [&](Vec3 d, Vec3 a, Vec3 b, Vec3 dv, Vec3 wa, Vec3 wb) {
         const EndForces f = change(s, d, a, b);
         return -dot(f.force, dv) + dot(f.torqueA, wa) + dot(f.torqueB, wb);
      };
      const double difference = work(d1, a1, b1, d2, a2, b2) - work(d2, a2, b2, d1, a1, b1);
      const double moments = dot(at.torqueA, cross(a2, a1)) + dot(at.torqueB, cross(b2, b1));
      QVERIFY2(std::abs(difference - moments) < 1e-12,
               qPrintable(QString("%1 %2").arg(difference).arg(moments)));
   }
}

/// A strain of 1e-15 comes out to 1e-9 of itself; from places it would have no digit left.
void SolverBondsEquilibriumTangentTest::smallStrainsKeepTheirDigits()
{
   BondEnds ends;
   ends.length = 1e-3;
   ends.displacement = {1e-18, 0, 0};
   BondConstants k;
   k.k[0] = 69e6;
   const double force = bondPoint<false>(ends, k, {}, {}).f.x;
   QVERIFY(std::abs(force / 69e-12 - 1) < 1e-9);
}

QTEST_APPLESS_MAIN(SolverBondsEquilibriumTangentTest)
#include "solver_bonds_equilibrium_tangent_test.moc"
