// Beam theory that studies are held against: it meets answers printed elsewhere.
#include "study/beam_theory.h"

#include <QTest>

#include <cmath>
#include <numbers>

using namespace diatom;

class StudyTheoryTest : public QObject
{
   Q_OBJECT

private slots:
   void aSlenderBarBendsAsTheElastica();
   void aSlenderBarSagsAsEulerAndBernoulliSay();
   void theFrequencyIsThatOfTimoshenkosBeam();
   void theShapeIsClampedAtOneEndAndOneAtTheOther();
};

void StudyTheoryTest::aSlenderBarBendsAsTheElastica()
{
   // Bisshopp and Drucker, "Large deflection of cantilever beams", 1945: by elliptic integrals, five digits.
   const double loads[] = {1, 2, 5, 10}, tips[] = {0.30172, 0.49346, 0.71379, 0.81061};
   const Bar bar = Bar::square(1, 1e-3, 1e9, 0.3, 1000);
   for (int k = 0; k < 4; ++k)
      // The bar of a thousandth in width stretches and shears by some 1e-6.
      QVERIFY(std::abs(bentTip(bar, loads[k] * bar.bending).across - tips[k]) < 1e-5);
}

void StudyTheoryTest::aSlenderBarSagsAsEulerAndBernoulliSay()
{
   const Bar bar = Bar::square(2, 1e-3, 1e9, 0.3, 1000);
   const double tip = sagOf(bar, 0.1, 2);
   // Shear adds (width / length)^2 of it, some 1e-6.
   QVERIFY(std::abs(tip / (0.1 * 16 / (8 * bar.bending)) - 1) < 1e-5);
}

void StudyTheoryTest::theFrequencyIsThatOfTimoshenkosBeam()
{
   // Solved otherwise, from the roots of the frequency equation, for 45 mm by 10 mm of 5 MPa: 325.476087335.
   const Bar bar = Bar::square(0.045, 0.01, 5e6, 0.3, 1100);
   QVERIFY(std::abs(2 * std::numbers::pi * bendingFrequency(bar) / 325.476087335 - 1) < 1e-9);
}

void StudyTheoryTest::theShapeIsClampedAtOneEndAndOneAtTheOther()
{
   const Bar bar = Bar::square(0.045, 0.01, 5e6, 0.3, 1100);
   const double hertz = bendingFrequency(bar);
   QCOMPARE(bendingShape(bar, hertz, 0).deflection, 0.0);
   QCOMPARE(bendingShape(bar, hertz, 0).turn, 0.0);
   QCOMPARE(bendingShape(bar, hertz, 0.045).deflection, 1.0);
   double before = 0;
   for (int k = 1; k <= 10; ++k) {
      const double now = bendingShape(bar, hertz, 0.0045 * k).deflection;
      QVERIFY(now > before);
      before = now;
   }
}

QTEST_APPLESS_MAIN(StudyTheoryTest)
#include "study_theory_test.moc"
