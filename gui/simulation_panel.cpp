#include "gui/simulation_panel.h"

#include <QKeyEvent>
#include <QScrollArea>
#include <QTabBar>

namespace diatom::gui {

SimulationPanel::SimulationPanel(Session *session, SimulationPlayer *player, QWidget *parent)
    : QTabWidget(parent), m_effects(new EffectsSection(session, this)),
      m_settings(new SettingsSection(session, this)), m_accuracy(new AccuracySection(session, player, this))
{
   setObjectName(QStringLiteral("simulationPanel"));
   setDocumentMode(true);
   tabBar()->setObjectName(QStringLiteral("simulationPanel.tabs"));
   tabBar()->setAccessibleName(tr("Pages of the simulation panel"));
   addPage(m_effects, tr("Effects"), tr("What is simulated, and why"));
   addPage(m_settings, tr("Settings"), tr("How it is simulated"));
   addPage(m_accuracy, tr("Accuracy"), tr("What accuracy costs in time"));
   connect(m_effects, &EffectsSection::evidenceChosen, this, &SimulationPanel::evidenceChosen);
   connect(m_accuracy, &AccuracySection::evidenceChosen, this, &SimulationPanel::evidenceChosen);
   connect(m_accuracy, &AccuracySection::stableStepKnown, m_settings, &SettingsSection::setStableStep);
   connect(m_effects, &EffectsSection::failed, this, &SimulationPanel::failed);
}

void SimulationPanel::addPage(QWidget *section, const QString &title, const QString &tip)
{
   auto *area = new QScrollArea(this);
   area->setWidgetResizable(true);
   area->setFrameShape(QFrame::NoFrame);
   area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
   area->setWidget(section);
   setTabToolTip(addTab(area, title), tip);
}

bool SimulationPanel::event(QEvent *event)
{
   // These keys mean something to buttons and fields; elsewhere in the window they play or fill.
   if (event->type() == QEvent::ShortcutOverride) {
      const auto *key = static_cast<QKeyEvent *>(event);
      if (key->key() == Qt::Key_Space || key->key() == Qt::Key_Return || key->key() == Qt::Key_Enter) {
         event->accept();
         return true;
      }
   }
   return QTabWidget::event(event);
}

} // namespace diatom::gui
