// The simulation panel under test: a sample opened, a page shown, and what a user reads on it.
#pragma once

#include "studio.h"

#include <QAbstractButton>
#include <QComboBox>
#include <QElapsedTimer>
#include <QLineEdit>
#include <QTabBar>
#include <QTimer>
#include <QToolBar>

#include <algorithm>

namespace diatom::test {

enum Page { kEffects, kSettings, kAccuracy };

class PanelStudio : public Studio
{
public:
   bool openSample(const char *name)
   {
      return choose({"menu.file", "menu.samples"}, (std::string("file.sample.") + name).c_str()) &&
             QTest::qWaitFor([&] { return window.windowTitle().contains(name) && !window.busy(); }, 20000);
   }
   /// By the tool column's button and the page's tab.
   bool openPanel(Page page)
   {
      if (!panel().isVisible())
         for (QToolButton *button : window.findChild<QToolBar *>("toolColumn")->findChildren<QToolButton *>())
            if (button->defaultAction() == action("simulate.panel"))
               QTest::mouseClick(button, Qt::LeftButton);
      if (!QTest::qWaitFor([&] { return panel().isVisible(); }))
         return false;
      auto *tabs = panel().findChild<QTabBar *>("simulationPanel.tabs");
      QTest::mouseClick(tabs, Qt::LeftButton, {}, tabs->tabRect(page).center());
      return panel().currentIndex() == page;
   }
   bool probed(int timeout = test::kPatience)
   {
      return QTest::qWaitFor([&] { return panel().accuracy().probe() && !panel().accuracy().busy(); },
                             timeout);
   }
   bool planned()
   {
      return QTest::qWaitFor([&] { return panel().effects().current(); }, 10000);
   }

   gui::SimulationPanel &panel() { return *window.findChild<gui::SimulationPanel *>("simulationPanel"); }
   const gui::AccuracyTable &table() { return *window.findChild<gui::AccuracyTable *>("accuracyTable"); }
   const gui::WorkPrecisionPlot &plot()
   {
      return *window.findChild<gui::WorkPrecisionPlot *>("workPrecisionPlot");
   }
   const Setup &setup() { return window.session().design().setup; }
   QString hash() { return window.session().stateHash(); }
   void press(const char *name)
   {
      QTest::mouseClick(window.findChild<QAbstractButton *>(QString::fromUtf8(name)), Qt::LeftButton);
   }
   QLineEdit *field(const char *name) { return window.findChild<QLineEdit *>(QString::fromUtf8(name)); }
   void type(const char *name, const QString &text)
   {
      field(name)->setFocus();
      field(name)->selectAll();
      QTest::keyClicks(field(name), text);
      QTest::keyClick(field(name), Qt::Key_Return);
   }
   /// The sentence beside a field.
   QString beside(const char *name) { return field(name)->accessibleDescription(); }
   /// Everything that can be read on the panel.
   QString everyWord()
   {
      QString all;
      for (const QLabel *label : panel().findChildren<QLabel *>())
         all += label->text() + QLatin1Char('\n') + label->toolTip() + QLatin1Char('\n');
      for (const QLineEdit *line : panel().findChildren<QLineEdit *>())
         all += line->text() + QLatin1Char('\n');
      return all + plot().accessibleName();
   }
};

/// The longest time the event loop did not come round, s, while this lives.
class StallWatch
{
public:
   StallWatch()
   {
      m_clock.start();
      QObject::connect(&m_timer, &QTimer::timeout, &m_timer, [this] {
         m_longest = std::max(m_longest, 1e-9 * double(m_clock.nsecsElapsed()));
         m_clock.restart();
      });
      m_timer.start(0);
   }
   double longest() const { return m_longest; }

private:
   QTimer m_timer;
   QElapsedTimer m_clock;
   double m_longest = 0;
};

} // namespace diatom::test
