// The plot of a study: which rows one line joins, and what is marked.
#include "study/accuracy_report.h"

#include <QTest>

using namespace diatom;

class StudyChartTest : public QObject
{
   Q_OBJECT

private slots:
   void aLineJoinsStepsOrResolutions();
   void rowsWithoutAnErrorAreNotDrawn();
   void theFrontIsWhatNothingBeats();
};

namespace {

AccuracyRow rowOf(const char *analysis, const char *setting, int resolution, double seconds,
                  std::optional<double> error)
{
   AccuracyRow row;
   row.analysis = analysis;
   row.setting = setting;
   row.resolution = resolution;
   row.seconds = seconds;
   row.error = error;
   return row;
}

AccuracyStudy study()
{
   AccuracyStudy made;
   made.tolerance = 0.01;
   made.rows = {
       rowOf("statics", "statics", 1, 0.001, 0.04),     rowOf("statics", "statics", 2, 0.01, 0.02),
       rowOf("statics", "statics", 3, 0.2, 0.005),      rowOf("dynamics", "verlet f64", 1, 0.1, 0.04),
       rowOf("dynamics", "verlet f64", 1, 0.2, 0.04),   rowOf("dynamics", "verlet f64", 2, 1, 0.02),
       rowOf("dynamics", "rk4 f64", 1, 1, std::nullopt)};
   made.cheapest = 2;
   return made;
}

} // namespace

void StudyChartTest::aLineJoinsStepsOrResolutions()
{
   const Chart chart = accuracyChart(study());
   QCOMPARE(chart.series.size(), std::size_t{3});
   QCOMPARE(chart.series[0].name, std::string("statics"));
   QCOMPARE(chart.series[0].points.size(), std::size_t{3});
   QCOMPARE(chart.series[0].points[2].label, std::string("3x"));
   QCOMPARE(chart.series[1].name, std::string("verlet f64"));
   QCOMPARE(chart.series[1].points.size(), std::size_t{2});
   QCOMPARE(chart.series[2].name, std::string("verlet f64 2x"));
}

void StudyChartTest::rowsWithoutAnErrorAreNotDrawn()
{
   for (const Series &series : accuracyChart(study()).series)
      QVERIFY(series.name.find("rk4") == std::string::npos);
}

void StudyChartTest::theFrontIsWhatNothingBeats()
{
   const Chart chart = accuracyChart(study());
   QCOMPARE(chart.front.size(), std::size_t{3});
   QVERIFY(chart.marked && chart.marked->y == 0.005);
   QCOMPARE(chart.marked->label, std::string("cheapest: statics 3x, 0.5 %"));
}

QTEST_APPLESS_MAIN(StudyChartTest)
#include "study_chart_test.moc"
