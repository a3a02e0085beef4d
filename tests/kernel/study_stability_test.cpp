// The hard cases in brief: each keeps the bounds that were set for it. Every bound carries its reason in the
// row itself.
#include "study/stability_study.h"
#include "support/support.h"

#include <QTest>

using namespace diatom;

class StudyStabilityTest : public QObject
{
   Q_OBJECT

private slots:
   void initTestCase();
   void everyCaseKeepsItsBounds_data();
   void everyCaseKeepsItsBounds();
   void aCheckOfNothingFails();
   void anUnknownCaseIsRefused();
   void cancelStopsIt();
   void tablesHoldEveryCheck();
};

void StudyStabilityTest::initTestCase()
{
   QVERIFY2(test::catalogue()->offer(DIATOM_SOLVER_1, "org.diatom_cad.solver.bonds"),
            "the bond solver was not built");
}

void StudyStabilityTest::everyCaseKeepsItsBounds_data()
{
   QTest::addColumn<QString>("id");
   for (const auto &[id, scene] : stabilityRows())
      QTest::newRow(id.c_str()) << QString::fromStdString(id);
}

void StudyStabilityTest::everyCaseKeepsItsBounds()
{
   QFETCH(QString, id);
   const Job job;
   StabilityRequest request;
   request.rows = {id.toStdString()};
   const auto study = studyStability(test::catalogue(), request, job);
   DIATOM_VERIFY_OK(study);
   QCOMPARE(study->rows.size(), std::size_t{1});
   const StabilityRow &row = study->rows.front();
   QVERIFY2(row.failure.empty(), row.failure.c_str());
   QVERIFY(!row.checks.empty());
   for (const StabilityCheck &check : row.checks)
      QVERIFY2(check.holds(),
               qPrintable(
                   QString("%1: %2, bound %3").arg(check.what.c_str()).arg(check.measured).arg(check.bound)));
}

void StudyStabilityTest::aCheckOfNothingFails()
{
   QVERIFY(!(StabilityCheck{"nan", std::nan(""), 1, ""}.holds()));
   QVERIFY(!(StabilityCheck{"above", 2, 1, ""}.holds()));
   QVERIFY((StabilityCheck{"at", 1, 1, ""}.holds()));
   QVERIFY(!StabilityRow{}.holds()); // nothing was looked at
   StabilityRow stopped;
   stopped.checks = {{"at", 1, 1, ""}};
   QVERIFY(stopped.holds());
   stopped.failure = "it stopped";
   QVERIFY(!stopped.holds());
}

void StudyStabilityTest::anUnknownCaseIsRefused()
{
   const Job job;
   StabilityRequest request;
   request.rows = {"softness"};
   const auto study = studyStability(test::catalogue(), request, job);
   QVERIFY(!study);
   QVERIFY(study.error().code == ErrorCode::usage);
   QVERIFY(study.error().message.find("softness") != std::string::npos);
}

void StudyStabilityTest::cancelStopsIt()
{
   Job job;
   job.cancel();
   const auto study = studyStability(test::catalogue(), {}, job);
   QVERIFY(!study);
   QVERIFY(study.error().code == ErrorCode::cancelled);
}

void StudyStabilityTest::tablesHoldEveryCheck()
{
   StabilityStudy study;
   StabilityRow row;
   row.id = "one";
   row.checks = {{"a", 1, 2, "why"}, {"b", std::nan(""), 2, "why"}};
   row.failure = "stopped";
   study.rows = {row};
   const std::string csv = stabilityCsv(study), page = stabilityMarkdown(study);
   QCOMPARE(std::count(csv.begin(), csv.end(), '\n'), 4);
   QCOMPARE(std::count(page.begin(), page.end(), '\n'), 5);
   const auto json = stabilityJson(study);
   QCOMPARE(json["rows"][0]["checks"].size(), std::size_t{2});
   QVERIFY(json["rows"][0]["checks"][1]["measured"].is_null()); // JSON knows no NaN
   QCOMPARE(json["holds"].get<bool>(), false);
}

QTEST_APPLESS_MAIN(StudyStabilityTest)
#include "study_stability_test.moc"
