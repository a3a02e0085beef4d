// Quantities, convergence and the accuracy probe: what is told is so, what cannot be told is called unknown.
#include "kernel/study_scene.h"
#include "study/accuracy_probe.h"

#include <QTest>

#include <cmath>

using namespace diatom;
using test::cantilever;
using test::subjectOf;
using test::Workbench;

namespace {

Quantity quantity(const char *text)
{
   const auto parsed = parseQuantity(text);
   if (!parsed)
      qFatal("%s", parsed.error().message.c_str());
   return *parsed;
}

/// A curve of a run at step h whose error is c h^order.
History curveAt(double h, double order)
{
   History curve;
   for (int k = 0; k <= 32; ++k) {
      const double t = k / 32.0;
      curve.time.push_back(t);
      curve.value.push_back(std::sin(6 * t) + 0.3 * std::pow(h, order) * t);
   }
   return curve;
}

} // namespace

class StudyProbeTest : public QObject
{
   Q_OBJECT

private slots:
   void initTestCase();
   void quantitiesReadBackAsWritten();
   void malformedQuantitiesAreRefusedWithTheForm();
   void theFrequencyOfASineIsItsFrequency();
   void richardsonFindsOrderAndErrorOfAKnownLaw();
   void runsThatDoNotConvergeGiveNoError();
   void theBusiestCellOfACantileverIsItsTip();
   void theBondThatLimitsTheStepIsTheStiffestPair();
   void theProbesErrorIsTheErrorOfARunMade();
   void finerPresetsErrLessAndTakeLonger();
   void aWindowFarTooShortForTheRunLeavesTheErrorUnknown();
   void theProbeStopsSoonAfterACancel();
   void aProbeOfRestOrOfAMissingCellIsRefused();
};

void StudyProbeTest::initTestCase()
{
   QVERIFY2(test::catalogue()->offer(DIATOM_SOLVER_1, Setup().solver), "the bond solver was not built");
}

void StudyProbeTest::quantitiesReadBackAsWritten()
{
   for (const char *text : {"0,13,0:z", "-1,2,3:vx@0.05", "0,0,0:rx@rest", "4,5,6:y@frequency"})
      QCOMPARE(quantity(text).text(), std::string(text));
   QCOMPARE(quantity("0,0,0:z@frequency").unit(), std::string("Hz"));
   QCOMPARE(quantity("0,0,0:rx").unit(), std::string("rad"));
}

void StudyProbeTest::malformedQuantitiesAreRefusedWithTheForm()
{
   for (const char *text : {"", "0,0:z", "0,0,0", "0,0,0:q", "0,0,0:z@", "0,0,0:z@-1", "a,0,0:z"}) {
      const auto parsed = parseQuantity(text);
      QVERIFY2(!parsed, text);
      QVERIFY(parsed.error().code == ErrorCode::usage);
   }
}

void StudyProbeTest::theFrequencyOfASineIsItsFrequency()
{
   History curve;
   for (int k = 0; k <= 400; ++k) {
      curve.time.push_back(k / 400.0);
      curve.value.push_back(2 + std::sin(2 * M_PI * 7.3 * curve.time.back() + 0.4));
   }
   const auto frequency = historyFrequency(curve);
   QVERIFY(frequency);
   // Crossings are placed by a line between samples 1/55 of a period apart, off by some 1e-4 of a period of
   // six.
   QVERIFY(std::abs(*frequency - 7.3) < 7.3 * 1e-4);
   curve.value.assign(curve.value.size(), 1.0);
   QVERIFY(!historyFrequency(curve));
}

void StudyProbeTest::richardsonFindsOrderAndErrorOfAKnownLaw()
{
   for (const double order : {1.0, 2.0, 4.0}) {
      const Convergence found =
          convergenceOf(curveAt(0.1, order), curveAt(0.05, order), curveAt(0.025, order), 1);
      QVERIFY(found.asymptotic);
      // The law is exact, so that only rounding of sin(6 t) at 1e-16 against changes of 1e-7 or more is left.
      QVERIFY(std::abs(*found.order - order) < 1e-6);
      const double error = 0.3 * std::pow(0.1, order);
      QVERIFY(std::abs(*found.errorAt(1) / error - 1) < 1e-6);
      QVERIFY(std::abs(*found.errorAt(0.25) / (error * std::pow(0.25, order)) - 1) < 1e-6);
   }
}

void StudyProbeTest::runsThatDoNotConvergeGiveNoError()
{
   const Convergence chaos = convergenceOf(1.0, 1.2, 0.95);
   QVERIFY(!chaos.asymptotic);
   QVERIFY(!chaos.errorAt(1));
   QVERIFY(!chaos.doubt().empty());
   const Convergence still = convergenceOf(0.0, 0.0, 0.0);
   QVERIFY(!still.errorAt(1));
   const Convergence same = convergenceOf(1.0, 1.0, 1.0);
   QVERIFY(same.settled);
   QVERIFY(same.errorAt(1));
}

void StudyProbeTest::theBusiestCellOfACantileverIsItsTip()
{
   const Workbench bench = cantilever();
   const auto busiest = busiestQuantity(subjectOf(bench), {}, 0.02, bench.job);
   DIATOM_VERIFY_OK(busiest);
   QCOMPARE(busiest->text(), std::string("0,11,0:z"));
}

void StudyProbeTest::theBondThatLimitsTheStepIsTheStiffestPair()
{
   Workbench bench = cantilever();
   Material soft = test::material("soft");
   soft.density = 3500;
   soft.youngsModulus = 5e3; // a hundredth, so that the step could be ten times as long without the fibre
   bench.add(soft);
   for (std::int32_t y = 3; y < 12; ++y)
      bench.put("soft", {{0, y, 0}});
   const auto limit = findStepLimit(subjectOf(bench), {}, bench.job);
   DIATOM_VERIFY_OK(limit);
   QVERIFY(limit->hasBond);
   QCOMPARE(limit->materialA, std::string("fibre"));
   QCOMPARE(limit->materialB, std::string("fibre"));
   QVERIFY(limit->a.y <= 2 && limit->b.y <= 2);
   QVERIFY(limit->gainWithout);
   // Without fibre-fibre bonds the fibre-soft one is left, whose stiffness is nearly twice the soft ones':
   // sqrt(100 / 2) = 7, and the shares of mass make it a little more or less.
   QVERIFY(*limit->gainWithout > 5 && *limit->gainWithout < 10);
   const auto alone = findStepLimit(subjectOf(cantilever()), {}, bench.job);
   DIATOM_VERIFY_OK(alone);
   QVERIFY(!alone->gainWithout);
}

void StudyProbeTest::theProbesErrorIsTheErrorOfARunMade()
{
   const Workbench bench = cantilever();
   const Subject subject = subjectOf(bench);
   ProbeRequest request;
   request.until = 0.03;
   request.quantity = quantity("0,11,0:z");
   request.budget = 20; // ample: the probe covers the whole run
   const auto probe = probeAccuracy(subject, request, bench.job);
   DIATOM_VERIFY_OK(probe);
   QCOMPARE(probe->window, 0.03);
   const auto fine = runTrial(subject, {{"integrator", std::string("rk4")}}, *request.quantity, 0.03, 1,
                              std::llround(8 * 0.03 / probe->step), bench.job);
   const auto draft =
       runTrial(subject, {}, *request.quantity, 0.03, 1, std::llround(0.03 / probe->step), bench.job);
   DIATOM_VERIFY_OK(fine);
   DIATOM_VERIFY_OK(draft);
   QVERIFY(probe->presets[0].error.how == Knowledge::measured);
   const double actual =
       std::abs(draft->curve.value.back() - fine->curve.value.back()) / std::abs(fine->curve.value.back());
   qInfo("probe says %.3e, the run errs by %.3e at its end", probe->presets[0].error.value, actual);
   // The estimate is of the worst sample and carries Richardson's own error, the run's of the last sample.
   QVERIFY(probe->presets[0].error.value > 0.7 * actual && probe->presets[0].error.value < 3 * actual);
}

void StudyProbeTest::finerPresetsErrLessAndTakeLonger()
{
   const Workbench bench = cantilever();
   ProbeRequest request;
   request.until = 0.05;
   request.budget = 0.5;
   const auto probe = probeAccuracy(subjectOf(bench), request, bench.job);
   DIATOM_VERIFY_OK(probe);
   QCOMPARE(probe->quantity.text(), std::string("0,11,0:z"));
   QCOMPARE(probe->presets.size(), std::size_t(4));
   for (std::size_t k = 1; k < probe->presets.size(); ++k) {
      const PresetEstimate &coarse = probe->presets[k - 1], &fine = probe->presets[k];
      QVERIFY2(fine.error.how != Knowledge::unknown, fine.error.why.c_str());
      QVERIFY(fine.error.value < coarse.error.value);
      QVERIFY(fine.seconds.value > coarse.seconds.value);
   }
}

void StudyProbeTest::aWindowFarTooShortForTheRunLeavesTheErrorUnknown()
{
   const Workbench bench = cantilever();
   ProbeRequest request;
   request.until = 1000;
   request.budget = 0.05;
   const auto probe = probeAccuracy(subjectOf(bench), request, bench.job);
   DIATOM_VERIFY_OK(probe);
   QVERIFY(probe->window < request.until);
   for (const PresetEstimate &preset : probe->presets) {
      QVERIFY(preset.error.how == Knowledge::unknown);
      QVERIFY(!preset.error.why.empty());
      QVERIFY(preset.seconds.how == Knowledge::predicted); // the time of a step is known all the same
   }
}

void StudyProbeTest::theProbeStopsSoonAfterACancel()
{
   const Workbench bench = cantilever();
   const Subject subject = subjectOf(bench);
   Job job([&](double, std::string_view) { job.cancel(); }); // as soon as it is at work
   ProbeRequest request;
   request.until = 1e5;
   request.budget = 1e4; // hours, were it not for the cancel
   const auto probe = probeAccuracy(subject, request, job);
   QVERIFY(!probe);
   QVERIFY(probe.error().code == ErrorCode::cancelled);
}

void StudyProbeTest::aProbeOfRestOrOfAMissingCellIsRefused()
{
   const Workbench bench = cantilever();
   ProbeRequest request;
   request.until = 0.01;
   for (const char *text : {"0,11,0:z@rest", "5,5,5:z"}) {
      request.quantity = quantity(text);
      const auto probe = probeAccuracy(subjectOf(bench), request, bench.job);
      QVERIFY(!probe);
      QVERIFY(probe.error().code == ErrorCode::usage);
   }
}

QTEST_APPLESS_MAIN(StudyProbeTest)
#include "study_probe_test.moc"
