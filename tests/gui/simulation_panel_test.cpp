// The panel's pages on effects and settings: what they say is what the kernel plans, and every switch is a
// command that undo takes back.
#include "panel_studio.h"

#include <QTemporaryDir>

using namespace diatom;
using namespace diatom::test;

class SimulationPanelTest : public QObject
{
   Q_OBJECT

private slots:
   void itSaysWhatToDoWhereThereIsNothing()
   {
      PanelStudio studio;
      QVERIFY(studio.ready());
      QVERIFY(!studio.panel().isVisible());
      QVERIFY(studio.openPanel(kEffects));
      QVERIFY(studio.label("effects.intro").startsWith("Place some cells"));
      QVERIFY(studio.openPanel(kAccuracy));
      QVERIFY(studio.label("accuracy.status").startsWith("Place some cells"));
      QVERIFY(!studio.panel().accuracy().busy());
      studio.type("accuracy.ask", "1 %");
      QVERIFY(studio.beside("accuracy.ask").contains("place some cells"));
   }

   void effectsAreThoseThatTheKernelPlans()
   {
      PanelStudio studio;
      QVERIFY(studio.ready());
      QVERIFY(studio.openSample("gripper"));
      QVERIFY(studio.openPanel(kEffects));
      QVERIFY(studio.planned());
      const auto &hierarchy = *studio.window.session().hierarchy();
      const auto effects =
          planEffects(hierarchy, studio.setup(), findNetworks(hierarchy, studio.setup(), Job()));
      QVERIFY(std::any_of(effects.begin(), effects.end(), [](const Effect &e) { return e.on; }));
      for (const Effect &effect : effects) {
         const std::string id = "effect." + effect.name;
         QCOMPARE(studio.label((id + ".state").c_str()), QString(effect.on ? "on" : "off"));
         QCOMPARE(studio.label((id + ".why").c_str()), QString::fromStdString(effect.why));
         QCOMPARE(studio.label((id + ".cost").c_str()), QString("cost unknown")); // nothing was measured
      }
   }

   void anEffectIsForcedOffAndBackByUndo()
   {
      PanelStudio studio;
      QVERIFY(studio.ready());
      QVERIFY(studio.openSample("bending-beam"));
      QVERIFY(studio.openPanel(kEffects));
      QVERIFY(studio.planned());
      const QString before = studio.hash();
      QCOMPARE(studio.label("effect.gravity.state"), QString("on"));
      auto *chooser = studio.window.findChild<QComboBox *>("effect.gravity.switch");
      QCOMPARE(chooser->currentText(), QString("Auto"));
      QTest::keyClick(chooser, Qt::Key_End);
      QTRY_COMPARE(studio.label("effect.gravity.state"), QString("off"));
      QVERIFY(studio.setup().effects.at("gravity") == false);
      QVERIFY(studio.label("effect.gravity.why").startsWith("switched off"));
      QCOMPARE(studio.action("edit.undo")->text(), QString("&Undo effect gravity"));
      studio.key(Qt::Key_Z, Qt::ControlModifier);
      QCOMPARE(studio.hash(), before);
      QTRY_COMPARE(studio.label("effect.gravity.state"), QString("on"));
      QCOMPARE(chooser->currentText(), QString("Auto"));
   }

   void evidenceIsOutlinedInTheView()
   {
      PanelStudio studio;
      QVERIFY(studio.ready());
      QVERIFY(studio.openSample("bending-beam"));
      QVERIFY(studio.openPanel(kEffects));
      QVERIFY(studio.planned());
      studio.leave();
      QVERIFY(studio.settle());
      const QImage plain = studio.picture();
      studio.press("effect.damping.cells");
      QVERIFY(!studio.view().highlight().empty());
      QVERIFY(studio.settle());
      QVERIFY(studio.picture() != plain);
      QTest::mouseClick(studio.window.findChild<QLabel *>("effect.damping.why"), Qt::LeftButton); // the row
      QVERIFY(studio.view().highlight().empty());
      QVERIFY(studio.settle());
      QVERIFY(studio.picture() == plain);
   }

   void costsAreMeasuredWhenAsked()
   {
      PanelStudio studio;
      QVERIFY(studio.ready());
      QVERIFY(studio.openSample("bending-beam"));
      QVERIFY(studio.openPanel(kEffects));
      QVERIFY(studio.planned());
      studio.press("effects.measure");
      QTRY_VERIFY_WITH_TIMEOUT(
          studio
              .label("effect.gravity.cost") // noise may make it less than nothing, which is said in words
              .contains(QRegularExpression("^cost ([0-9.]+ ns|too small to measure)$")),
          test::kPatience);
      QCOMPARE(studio.label("effect.ground.cost"), QString("cost unknown")); // off: nothing to measure
   }

   void aChoiceOfTheSolverIsOneUndoStep()
   {
      PanelStudio studio;
      QVERIFY(studio.ready());
      QVERIFY(studio.openSample("bending-beam"));
      QVERIFY(studio.openPanel(kSettings));
      const QString before = studio.hash();
      // Whatever the solver declares is there.
      const Offer *offer = catalogue()->offer(DIATOM_SOLVER_1, studio.setup().solver);
      for (const Parameter &parameter : offer->provided->parameters)
         if (parameter.kind == Parameter::Kind::choice) {
            const auto *box = studio.window.findChild<QComboBox *>(QStringLiteral("setting.") +
                                                                   QString::fromStdString(parameter.name));
            QVERIFY2(box, parameter.name.c_str());
            QCOMPARE(box->count(), int(parameter.choices.size()));
         }
      auto *integrator = studio.window.findChild<QComboBox *>("setting.integrator");
      const int first = integrator->currentIndex();
      QTest::keyClick(integrator, first + 1 < integrator->count() ? Qt::Key_Down : Qt::Key_Up);
      QVERIFY(integrator->currentIndex() != first);
      QCOMPARE(std::get<std::string>(studio.setup().solverValues.at("integrator")),
               integrator->currentData().toString().toStdString());
      studio.key(Qt::Key_Z, Qt::ControlModifier);
      QCOMPARE(studio.hash(), before);
      QCOMPARE(integrator->currentIndex(), first);
   }

   void aStepIsTakenInUnitsOrRefusedInWords()
   {
      PanelStudio studio;
      QVERIFY(studio.ready());
      QVERIFY(studio.openSample("bending-beam"));
      QVERIFY(studio.openPanel(kSettings));
      const QString before = studio.hash();
      for (const char *bad : {"quick", "-3 us", "0", "5 parsecs", "nan", "1e999"}) {
         studio.type("setting.step", bad);
         QVERIFY2(studio.beside("setting.step").contains("20 us"), bad);
         QCOMPARE(studio.hash(), before);
      }
      QTest::keyClick(studio.field("setting.step"), Qt::Key_Escape);
      QCOMPARE(studio.beside("setting.step"), QString());
      QCOMPARE(studio.field("setting.step")->text(), QString("auto"));
      studio.type("setting.step", "20 us");
      QCOMPARE(studio.setup().step, 20e-6);
      QCOMPARE(studio.beside("setting.step"), QString());
      studio.type("setting.until", "50 ms");
      QCOMPARE(studio.setup().until, 0.05);
      studio.type("setting.until", "never");
      QVERIFY(studio.beside("setting.until").contains("leave it empty"));
      QCOMPARE(studio.setup().until, 0.05);
      studio.view().setFocus();
      studio.key(Qt::Key_Z, Qt::ControlModifier);
      studio.key(Qt::Key_Z, Qt::ControlModifier);
      QCOMPARE(studio.hash(), before);
   }

   void keysInThePanelDoNotPlayOrFill()
   {
      PanelStudio studio;
      QVERIFY(studio.ready());
      QVERIFY(studio.openSample("bending-beam"));
      QVERIFY(studio.openPanel(kEffects));
      QVERIFY(studio.planned());
      auto *button = studio.window.findChild<QAbstractButton *>("effect.damping.cells");
      button->setFocus();
      QTest::keyClick(button, Qt::Key_Space);
      QVERIFY(!studio.window.player().active());
      QVERIFY(!studio.view().highlight().empty()); // it was the button that was pressed
   }

   void everyControlOfThePanelHasAName()
   {
      PanelStudio studio;
      QVERIFY(studio.ready());
      QVERIFY(studio.openSample("bending-beam"));
      for (const Page page : {kEffects, kSettings, kAccuracy}) {
         QVERIFY(studio.openPanel(page));
         QVERIFY(studio.planned());
         for (const QWidget *widget : studio.panel().findChildren<QWidget *>())
            if (widget->isVisible() && (widget->inherits("QComboBox") || widget->inherits("QLineEdit"))) {
               QVERIFY2(!widget->accessibleName().isEmpty(), qPrintable(widget->objectName()));
               QVERIFY2(widget->focusPolicy() & Qt::TabFocus, qPrintable(widget->objectName()));
            }
      }
   }

   void itIsRememberedOpenAtItsPage()
   {
      QTemporaryDir folder;
      QSettings settings(folder.filePath("studio.ini"), QSettings::IniFormat);
      {
         gui::MainWindow window(catalogue(), &settings);
         window.show();
         QVERIFY(QTest::qWaitForWindowExposed(
             &window)); // two windows in turn: without a window manager none need be active
         window.findChild<QAction *>("simulate.panel")->trigger();
         auto *panel = window.findChild<gui::SimulationPanel *>("simulationPanel");
         QVERIFY(panel->isVisible());
         panel->findChild<QTabBar *>("simulationPanel.tabs")->setCurrentIndex(kSettings);
         window.close();
      }
      gui::MainWindow window(catalogue(), &settings);
      window.show();
      QVERIFY(QTest::qWaitForWindowExposed(
          &window)); // two windows in turn: without a window manager none need be active
      auto *panel = window.findChild<gui::SimulationPanel *>("simulationPanel");
      QVERIFY(panel->isVisible());
      QCOMPARE(panel->currentIndex(), int(kSettings));
      QVERIFY(window.findChild<QAction *>("simulate.panel")->isChecked());
      window.findChild<QAction *>("simulate.panel")->trigger();
      QVERIFY(!panel->isVisible());
   }
};

QTEST_MAIN(SimulationPanelTest)
#include "simulation_panel_test.moc"
