#include "gui/effect_entry.h"

#include "gui/readable.h"

#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QMouseEvent>
#include <QToolButton>

namespace diatom::gui {

EffectEntry::EffectEntry(const std::string &name, QWidget *parent)
    : QFrame(parent), m_name(name), m_state(new QLabel(this)), m_why(new QLabel(this)),
      m_cost(new QLabel(this)), m_switch(new QComboBox(this)), m_cells(new QToolButton(this))
{
   const QString id = QStringLiteral("effect.") + QString::fromStdString(name);
   const QString shown = wordText(QString::fromStdString(name));
   setObjectName(id);
   setAutoFillBackground(true);
   auto *title = new QLabel(QStringLiteral("<b>%1</b>").arg(shown.toHtmlEscaped()), this);
   m_state->setObjectName(id + QStringLiteral(".state"));
   m_state->setAlignment(Qt::AlignCenter);
   m_state->setFixedWidth(34);
   m_why->setObjectName(id + QStringLiteral(".why"));
   m_why->setWordWrap(true);
   m_why->setTextFormat(Qt::PlainText);
   m_cost->setObjectName(id + QStringLiteral(".cost"));
   m_cost->setToolTip(tr("What the effect adds to a step, for each cell"));
   m_switch->setObjectName(id + QStringLiteral(".switch"));
   m_switch->setAccessibleName(tr("Switch of %1").arg(shown));
   m_switch->setToolTip(tr("Auto: simulated where the design calls for it. On and off overrule that."));
   m_switch->addItem(tr("Auto"), QStringLiteral("auto"));
   m_switch->addItem(tr("On"), QStringLiteral("on"));
   m_switch->addItem(tr("Off"), QStringLiteral("off"));
   m_cells->setObjectName(id + QStringLiteral(".cells"));
   m_cells->setText(tr("Show cells"));
   m_cells->setAccessibleName(tr("Show the cells that %1 is about").arg(shown));
   m_cells->setCheckable(true);
   m_cells->setAutoRaise(true);
   connect(m_switch, &QComboBox::activated, this,
           [this] { emit forced(m_switch->currentData().toString()); });
   connect(m_cells, &QToolButton::clicked, this, &EffectEntry::clicked);

   auto *layout = new QGridLayout(this);
   layout->setContentsMargins(8, 5, 8, 5);
   layout->setHorizontalSpacing(8);
   layout->setVerticalSpacing(2);
   layout->addWidget(m_state, 0, 0);
   layout->addWidget(title, 0, 1);
   layout->addWidget(m_cost, 0, 2, Qt::AlignRight);
   layout->addWidget(m_switch, 0, 3);
   layout->addWidget(m_why, 1, 1, 1, 2);
   layout->addWidget(m_cells, 1, 3, Qt::AlignTop | Qt::AlignRight);
   layout->setColumnStretch(1, 1);
}

void EffectEntry::setEffect(const Effect &effect, std::optional<bool> forced, std::optional<double> cost)
{
   m_state->setText(effect.on ? tr("on") : tr("off"));
   m_state->setStyleSheet(effect.on ? QStringLiteral("background: #1e6e50; color: white; border-radius: 4px;")
                                    : QStringLiteral("border: 1px solid palette(mid); border-radius: 4px;"));
   m_why->setText(QString::fromStdString(effect.why));
   // Less than nothing is noise of the measurement.
   m_cost->setText(!cost       ? tr("cost unknown")
                   : *cost > 0 ? tr("cost %1 ns").arg(figureText(*cost))
                               : tr("cost too small to measure"));
   m_switch->setCurrentIndex(!forced ? 0 : *forced ? 1 : 2);
   m_evidence = effect.evidence;
   m_cells->setVisible(!m_evidence.empty());
   m_cells->setToolTip(tr("Some of the cells: %1").arg(cellsText(m_evidence)));
   if (m_evidence.empty())
      setChosen(false);
}

void EffectEntry::setChosen(bool chosen)
{
   m_cells->setChecked(chosen);
   setBackgroundRole(chosen ? QPalette::AlternateBase : QPalette::Base);
}

void EffectEntry::mouseReleaseEvent(QMouseEvent *event)
{
   QFrame::mouseReleaseEvent(event);
   if (event->button() == Qt::LeftButton && !m_evidence.empty())
      emit clicked();
}

} // namespace diatom::gui
