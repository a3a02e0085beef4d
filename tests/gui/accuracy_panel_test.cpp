// The panel's page on accuracy: a newcomer opens a sample, waits for the probe and reads what accuracy costs
// (journey J8 of the design).
#include "panel_studio.h"

#include <cmath>

using namespace diatom;
using namespace diatom::test;

class AccuracyPanelTest : public QObject
{
   Q_OBJECT

private slots:
   void aNewcomerReadsWhatAccuracyCosts();
   void anEditWhileProbingBeginsAnew();
   void aHiddenPageDoesNothing();
   void anAccuracyAskedForIsPicked();
   void aToldTimeIsHeldAgainstTheRun();
};

void AccuracyPanelTest::aNewcomerReadsWhatAccuracyCosts()
{
   PanelStudio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.openSample("bending-beam"));
   const QString before = studio.hash();
   QVERIFY(studio.openPanel(kAccuracy));
   QVERIFY(studio.label("accuracy.status").startsWith("Measuring"));
   QVERIFY(studio.probed());
   const AccuracyProbe &probe = *studio.panel().accuracy().probe();
   QVERIFY(studio.label("accuracy.status").contains("which moves most"));
   const QRegularExpression duration("^[0-9.]+ (ns|us|ms|s|min|h)(, (measured|predicted))?$"),
       percent("^(under )?[0-9.]+ %, (measured|predicted)$");
   for (const Preset &preset : kPresets) {
      QVERIFY2(studio.table().text(preset.name, "step").contains(duration), preset.name);
      QVERIFY2(studio.table().text(preset.name, "seconds").contains(duration), preset.name);
      const QString error = studio.table().text(preset.name, "error");
      QVERIFY2(error == "unknown" || error.contains(percent), qPrintable(error));
   }
   // The beam is smooth, its run converges: at least the coarsest errors are known, and finer is better.
   QVERIFY(studio.plot().points().size() >= 2);
   for (std::size_t k = 1; k < studio.plot().points().size(); ++k)
      QVERIFY(studio.plot().points()[k].error < studio.plot().points()[k - 1].error);
   QVERIFY(studio.plot().ringed());
   QVERIFY(studio.label("accuracy.limit").contains("the bond ("));
   studio.press("accuracy.showBond");
   QCOMPARE(studio.view().highlight().size(), std::size_t(2));
   const QString words = studio.everyWord();
   QVERIFY2(!words.contains(QRegularExpression("\\b(nan|inf)\\b", QRegularExpression::CaseInsensitiveOption)),
            qPrintable(words));

   studio.press("preset.Fine");
   QCOMPARE(studio.setup().step, probe.presets[2].step);
   QVERIFY(studio.window.findChild<QAbstractButton *>("preset.Fine")->isChecked());
   QVERIFY(studio.panel().accuracy().probe()); // a step changes nothing that it was measured on
   QVERIFY(!studio.panel().accuracy().busy());
   QCOMPARE(studio.plot().ringed()->error, studio.plot().points()[2].error);
   QCOMPARE(studio.table().text("now", "error"), studio.table().text("Fine", "error"));
   QCOMPARE(studio.action("edit.undo")->text(), QString("&Undo step"));
   studio.view().setFocus();
   studio.key(Qt::Key_Z, Qt::ControlModifier);
   QCOMPARE(studio.hash(), before);
   QVERIFY(!studio.window.findChild<QAbstractButton *>("preset.Fine")->isChecked());

   // Three times the limit: said before the run.
   QVERIFY(studio.openPanel(kSettings));
   studio.type("setting.step", QString::number(3e6 * probe.limit.stableStep) + " us");
   QVERIFY(studio.beside("setting.step").startsWith("Longer than the longest stable step"));
   QCOMPARE(studio.table().text("now", "error"), QString("unknown"));
   QCOMPARE(studio.table().text("now", "seconds"), QString("unknown"));
   QVERIFY(!studio.plot().ringed());
}

void AccuracyPanelTest::anEditWhileProbingBeginsAnew()
{
   PanelStudio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.openSample("bending-beam"));
   QVERIFY(studio.openPanel(kAccuracy));
   StallWatch watch;
   QVERIFY(QTest::qWaitFor([&] { return studio.panel().accuracy().busy(); }));
   QVERIFY(!studio.panel().accuracy().probe());
   const auto cells = studio.cells();
   studio.view().setFocus();
   for (int x = 8; x < 14 && studio.cells() == cells; ++x)
      studio.click(*studio.view().screenPosBase({x, -6, 0}));
   QVERIFY(studio.cells() > cells);
   QVERIFY(studio.panel().accuracy().busy());
   QVERIFY(!studio.panel().accuracy().probe());
   QVERIFY(studio.label("accuracy.status").startsWith("Measuring"));
   QVERIFY(QTest::qWaitFor([&] { return !studio.panel().accuracy().busy(); }, test::kPatience));
   QVERIFY(!studio.label("accuracy.status").startsWith("Measuring"));
   qInfo("longest stall of the event loop: %.0f ms", 1e3 * watch.longest());
}

void AccuracyPanelTest::aHiddenPageDoesNothing()
{
   PanelStudio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.openSample("bending-beam"));
   QVERIFY(!studio.panel().accuracy().busy());
   QVERIFY(studio.openPanel(kAccuracy));
   QVERIFY(studio.panel().accuracy().busy());
   studio.key(Qt::Key_F8);
   QVERIFY(!studio.panel().isVisible());
   QVERIFY(!studio.panel().accuracy().busy());
   QVERIFY(!studio.panel().accuracy().probe());
}

void AccuracyPanelTest::anAccuracyAskedForIsPicked()
{
   PanelStudio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.openSample("bending-beam"));
   const QString before = studio.hash();
   QVERIFY(studio.openPanel(kAccuracy));
   for (const char *bad : {"0", "-1 %", "perfect", "100 %", "nan"}) {
      studio.type("accuracy.ask", bad);
      QVERIFY2(studio.beside("accuracy.ask").contains("such as 1 %"), bad);
      QCOMPARE(studio.hash(), before);
   }
   studio.type("accuracy.ask", "1 %");
   QCOMPARE(studio.beside("accuracy.ask"), QString());
   QTRY_VERIFY_WITH_TIMEOUT(studio.label("accuracy.answer").startsWith("Picked "), 120000);
   QVERIFY2(studio.label("accuracy.answer").contains("is the cheapest of"),
            qPrintable(studio.label("accuracy.answer")));
   QVERIFY(studio.setup().step > 0);
   QVERIFY(studio.hash() != before);
   studio.view().setFocus();
   studio.key(Qt::Key_Z, Qt::ControlModifier); // settings and step together
   QCOMPARE(studio.hash(), before);
}

void AccuracyPanelTest::aToldTimeIsHeldAgainstTheRun()
{
   PanelStudio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.openSample("bending-beam"));
   QVERIFY(studio.openPanel(kSettings));
   studio.type("setting.until", "50 ms");
   QVERIFY(studio.openPanel(kAccuracy));
   QVERIFY(studio.probed());
   QCOMPARE(studio.panel().accuracy().probe()->until, 0.05);
   studio.view().setFocus();
   studio.key(Qt::Key_Space);
   QTRY_VERIFY_WITH_TIMEOUT(studio.window.player().tally().steps > 0, test::kPatience);
   const double step = studio.window.player().tally().step;
   QTRY_VERIFY_WITH_TIMEOUT(studio.window.player().finished(), test::kPatience);
   QTRY_VERIFY(studio.label("status.run").contains("finished"));
   const gui::RunTally tally = studio.window.player().tally();
   QCOMPARE(tally.time, 0.05);
   // The steps of a run without slices: all alike, so many of them.
   QVERIFY(std::abs(tally.step / step - 1) < 1e-9); // rounding of what is left
   QCOMPARE(double(tally.steps), std::round(0.05 / step));
   const QString account = studio.label("accuracy.account");
   QVERIFY2(
       account.contains(QRegularExpression(
           "^Last run, 50 ms in [0-9]+ steps: told [0-9.]+ [a-z]+, took [0-9.]+ [a-z]+ of stepping\\.$")),
       qPrintable(account));
   qInfo("%s", qPrintable(account));
   studio.key(Qt::Key_Space); // once more from the start
   QTRY_VERIFY(!studio.window.player().finished());
   QTRY_VERIFY_WITH_TIMEOUT(studio.window.player().finished(), test::kPatience);
}

QTEST_MAIN(AccuracyPanelTest)
#include "accuracy_panel_test.moc"
