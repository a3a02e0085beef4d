// What accuracy costs on the open design: a probe in the background while the page is seen, its table and
// plot, presets by a click, an accuracy asked for, and what became of a told time.
#pragma once

#include "gui/accuracy_jobs.h"
#include "gui/accuracy_table.h"
#include "gui/background.h"
#include "gui/session.h"
#include "gui/simulation_player.h"
#include "gui/value_field.h"
#include "gui/work_precision_plot.h"

#include <QTimer>
#include <QWidget>

#include <optional>

class QLabel;
class QPushButton;
class QToolButton;

namespace diatom::gui {

class AccuracySection : public QWidget
{
   Q_OBJECT

public:
   AccuracySection(Session *session, SimulationPlayer *player, QWidget *parent);

   /// Whether a probe or a search for settings is to come or going on.
   bool busy() const { return m_wait.isActive() || m_probing.busy() || m_choosing.busy(); }
   /// Of the design as it is, whatever its step; null while there is none.
   const AccuracyProbe *probe() const;

signals:
   /// Cells to point out in the view; none = no more.
   void evidenceChosen(const std::vector<Index> &cells);
   /// s; 0 = not known, or none.
   void stableStepKnown(double step);

protected:
   void showEvent(QShowEvent *event) override;
   void hideEvent(QHideEvent *event) override;

private:
   bool isOfDesign(const Design &design) const;
   void designChanged();
   /// A probe soon, where one is missing and it would not be in the way.
   void wantProbe();
   void beginProbe();
   void applyStep(double step);
   QString ask(const QString &text);
   void choose(double error);
   void takeChoice(const AccuracyChoice &choice);
   void runChanged();
   void refresh();
   void showStatus();
   void showLimit();
   std::optional<PresetEstimate> estimateNow() const;
   Subject subject() const;

   Session *m_session;
   SimulationPlayer *m_player;
   Background m_probing, m_choosing;
   QTimer m_wait;
   Design m_design;                              // what the probe is of, done or going on
   std::optional<Result<AccuracyProbe>> m_probe; // of m_design
   QString m_answer;                             // to an accuracy asked for
   bool m_applying = false;                      // an edit of our own

   QLabel *m_status, *m_answerLabel, *m_limit;
   ValueField *m_ask;
   QPushButton *m_pick;
   AccuracyTable *m_table;
   WorkPrecisionPlot *m_plot;
   QToolButton *m_show;
};

} // namespace diatom::gui
