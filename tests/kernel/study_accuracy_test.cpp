// Studies of accuracy: errors against the reference, the front, the cheapest setting, and what is written.
#include "core/file.h"
#include "study/accuracy_report.h"
#include "study/accuracy_samples.h"
#include "support/support.h"

#include <QTest>

#include <algorithm>
#include <cmath>

using namespace diatom;

namespace {

AccuracySample sample(const std::string &id)
{
   for (AccuracySample &one : accuracySamples())
      if (one.id == id)
         return one;
   qFatal("no such sample");
}

Result<AccuracyStudy> studied(const AccuracySample &one, double budget)
{
   AccuracyRequest request = one.request;
   request.budget = budget * kSlowdown;
   request.repeats = 1;
   const Job job;
   return studyAccuracy(test::catalogue(), one.design, request, job);
}

} // namespace

class StudyAccuracyTest : public QObject
{
   Q_OBJECT

private slots:
   void initTestCase();
   void theFrequencyOfABarIsWithinAPercentAtTheCheapestSetting();
   void nothingIsBothFasterAndBetterThanTheFront();
   void theReportHasARowForEachRunAndAPlot();
   void aWalkersStrideIsHeldAgainstItsFinestRunAndTellsWhatIsSure();
   void implicitStepsAreTriedAsLongAsTheMotionBears();
   void aQuantityOfNoCellIsRefused();
};

void StudyAccuracyTest::initTestCase()
{
   QVERIFY2(test::catalogue()->offer(DIATOM_SOLVER_1, Setup().solver), "the bond solver was not built");
}

void StudyAccuracyTest::theFrequencyOfABarIsWithinAPercentAtTheCheapestSetting()
{
   const auto study = studied(sample("frequency"), 3);
   DIATOM_VERIFY_OK(study);
   QVERIFY(study->reference.exact);
   QVERIFY(study->cheapest >= 0);
   QVERIFY(*study->rows[static_cast<std::size_t>(study->cheapest)].error <= 0.01);
   QVERIFY(study->careful >= 0);
   // Twelve bonds err by some 2e-4 against Timoshenko's beam (see the case of cantilever modes), and
   // crossings of a record by no more.
   QVERIFY(*study->rows[static_cast<std::size_t>(study->careful)].error < 2e-3);
}

void StudyAccuracyTest::nothingIsBothFasterAndBetterThanTheFront()
{
   const auto study = studied(sample("frequency"), 2);
   DIATOM_VERIFY_OK(study);
   QVERIFY(std::any_of(study->rows.begin(), study->rows.end(),
                       [](const AccuracyRow &row) { return row.onFront; }));
   for (const AccuracyRow &front : study->rows)
      for (const AccuracyRow &other : study->rows)
         if (front.onFront && other.error)
            QVERIFY(!(other.seconds < front.seconds && *other.error < *front.error));
}

void StudyAccuracyTest::theReportHasARowForEachRunAndAPlot()
{
   auto study = studied(sample("frequency"), 1);
   DIATOM_VERIFY_OK(study);
   QTemporaryDir dir;
   const std::filesystem::path folder = dir.path().toStdString();
   DIATOM_VERIFY_OK(writeAccuracy(*study, folder));
   const std::string csv = accuracyCsv(*study);
   QCOMPARE(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), study->rows.size() + 1);
   QCOMPARE(accuracyJson(*study)["rows"].size(), study->rows.size());
   if (!canPlot())
      QSKIP("this build has no PLplot");
   QVERIFY(std::filesystem::file_size(folder / "accuracy.svg") > 2000);
   QVERIFY(std::filesystem::file_size(folder / "accuracy.png") > 2000);
}

void StudyAccuracyTest::aWalkersStrideIsHeldAgainstItsFinestRunAndTellsWhatIsSure()
{
   const auto study = studied(sample("stride"), 4);
   DIATOM_VERIFY_OK(study);
   QVERIFY(!study->reference.exact);
   QVERIFY(study->sensitivity);
   // It walks a tenth of a cell and more; any one run of so chaotic a scene may end where it began.
   QVERIFY(std::any_of(study->rows.begin(), study->rows.end(),
                       [](const AccuracyRow &row) { return std::abs(row.value) > 1e-4; }));
   if (!study->reference.asymptotic)
      QVERIFY(!study->reference.doubt.empty());
   // No run is recommended that is not surer than what it is held against: the finest one is held against
   // itself and would always win.
   if (study->cheapest >= 0)
      QVERIFY(study->reference.ownError && *study->reference.ownError <= study->tolerance);
}

/// Only the end counts, so that no curve asks for steps of its own: a dozen or fewer are tried (ten times as
/// long as the solver's own). What they do not follow is the swing that the tip is left with, half a per cent
/// of its way.
void StudyAccuracyTest::implicitStepsAreTriedAsLongAsTheMotionBears()
{
   const auto study = studied(sample("stiff-flexure"), 5);
   DIATOM_VERIFY_OK(study);
   std::int64_t fewest = 0;
   for (const AccuracyRow &row : study->rows)
      if (row.setting.starts_with("implicit") && row.steps > 0 && row.error) {
         fewest = fewest == 0 ? row.steps : std::min(fewest, row.steps);
         QVERIFY2(*row.error < 0.007, qPrintable(QString::number(*row.error)));
         QVERIFY(std::abs(row.step * static_cast<double>(row.steps) / 0.01 - 1) < 1e-9);
      }
   QVERIFY2(fewest > 0 && fewest <= 12, qPrintable(QString::number(fewest)));
}

void StudyAccuracyTest::aQuantityOfNoCellIsRefused()
{
   AccuracySample one = sample("frequency");
   one.request.quantity = parseQuantity("99,0,0:z@frequency").value();
   const auto study = studied(one, 1);
   QVERIFY(!study);
   QVERIFY(study.error().code == ErrorCode::usage);
}

QTEST_APPLESS_MAIN(StudyAccuracyTest)
#include "study_accuracy_test.moc"
