// What is simulated, how, and what that costs: effects, settings and accuracy, each on a page of its own.
#pragma once

#include "gui/accuracy_section.h"
#include "gui/effects_section.h"
#include "gui/settings_section.h"

#include <QTabWidget>

namespace diatom::gui {

class SimulationPanel : public QTabWidget
{
   Q_OBJECT

public:
   SimulationPanel(Session *session, SimulationPlayer *player, QWidget *parent);

   EffectsSection &effects() { return *m_effects; }
   AccuracySection &accuracy() { return *m_accuracy; }
   QSize sizeHint() const override { return {390, 560}; }

signals:
   /// Cells to point out in the view; none = no more.
   void evidenceChosen(const std::vector<Index> &cells);
   void failed(const QString &message);

protected:
   bool event(QEvent *event) override;

private:
   void addPage(QWidget *section, const QString &title, const QString &tip);

   EffectsSection *m_effects;
   SettingsSection *m_settings;
   AccuracySection *m_accuracy;
};

} // namespace diatom::gui
