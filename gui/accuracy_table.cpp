#include "gui/accuracy_table.h"

#include "gui/readable.h"

#include <QGridLayout>
#include <QLabel>
#include <QPushButton>

#include <cmath>

namespace diatom::gui {

namespace {

QString knownText(Knowledge how)
{
   return how == Knowledge::measured    ? AccuracyTable::tr("measured")
          : how == Knowledge::predicted ? AccuracyTable::tr("predicted")
                                        : QString();
}

/// A figure with how it is known below it in small, the reason as tooltip.
void showEstimate(QLabel *label, const Estimate &estimate, const QString &figure)
{
   const bool known = estimate.how != Knowledge::unknown;
   const QString value = known ? figure : AccuracyTable::tr("unknown");
   const QString how = knownText(estimate.how);
   label->setText(how.isEmpty() ? value : QStringLiteral("%1<br><small>%2</small>").arg(value, how));
   label->setAccessibleName(how.isEmpty() ? value : value + QStringLiteral(", ") + how);
   label->setToolTip(wordText(QString::fromStdString(estimate.why)));
}

} // namespace

AccuracyTable::AccuracyTable(QWidget *parent) : QWidget(parent)
{
   setObjectName(QStringLiteral("accuracyTable"));
   auto *grid = new QGridLayout(this);
   grid->setContentsMargins(0, 0, 0, 0);
   grid->setHorizontalSpacing(10);
   grid->setVerticalSpacing(3);
   int column = 0;
   for (const QString &title : {tr("Preset"), tr("Step"), tr("Error"), tr("This run takes")}) {
      auto *head = new QLabel(QStringLiteral("<small>%1</small>").arg(title), this);
      grid->addWidget(head, 0, column);
      grid->setColumnStretch(column++, 1);
   }
   for (std::size_t k = 0; k < kPresets.size(); ++k) {
      const QString name = QString::fromUtf8(kPresets[k].name);
      Row &row = m_rows[k] = makeRow(grid, static_cast<int>(k) + 1, name);
      row.button = new QPushButton(name, this);
      row.button->setObjectName(QStringLiteral("preset.") + name);
      row.button->setCheckable(true);
      grid->addWidget(row.button, static_cast<int>(k) + 1, 0);
      connect(row.button, &QPushButton::clicked, this, [this, k] {
         m_rows[k].button->setChecked(!m_rows[k].button->isChecked()); // until the design says so
         emit applied(m_rows[k].asked);
      });
   }
   const int last = static_cast<int>(kPresets.size()) + 1;
   grid->addWidget(new QLabel(tr("As set now"), this), last, 0);
   m_now = makeRow(grid, last, QStringLiteral("now"));
   setEstimates({}, {});
}

AccuracyTable::Row AccuracyTable::makeRow(QGridLayout *grid, int row, const QString &id)
{
   Row made;
   int column = 1;
   for (const auto &[name, label] :
        {std::pair{"step", &made.step}, std::pair{"error", &made.error}, std::pair{"seconds", &made.seconds}})
   {
      *label = new QLabel(this);
      (*label)->setObjectName(QStringLiteral("preset.%1.%2").arg(id, QString::fromUtf8(name)));
      grid->addWidget(*label, row, column++);
   }
   return made;
}

void AccuracyTable::fill(Row &row, const PresetEstimate *estimate)
{
   row.asked = estimate ? estimate->step : 0;
   if (row.button)
      row.button->setEnabled(estimate);
   if (!estimate) {
      for (QLabel *label : {row.step, row.error, row.seconds}) {
         label->setText(QString(QChar(0x2013)));
         label->setAccessibleName(tr("not known yet"));
         label->setToolTip({});
      }
      return;
   }
   row.step->setText(durationText(estimate->step));
   row.step->setAccessibleName(row.step->text());
   row.step->setToolTip(tr("%1 % of the longest stable step").arg(figureText(100 * estimate->fraction)));
   showEstimate(row.error, estimate->error, percentText(estimate->error.value));
   showEstimate(row.seconds, estimate->seconds, durationText(estimate->seconds.value));
}

void AccuracyTable::setEstimates(const std::vector<PresetEstimate> &presets,
                                 const std::optional<PresetEstimate> &now)
{
   for (std::size_t k = 0; k < m_rows.size(); ++k) {
      Row &row = m_rows[k];
      fill(row, k < presets.size() ? &presets[k] : nullptr);
      row.button->setChecked(now && row.asked > 0 && std::abs(now->step / row.asked - 1) < 1e-6);
      row.button->setToolTip(kPresets[k].withHalf
                                 ? tr("Take this step. The time is of two runs, the second at half the step, "
                                      "so that the error of the first is known.")
                                 : tr("Take this step"));
   }
   fill(m_now, now ? &*now : nullptr);
}

QString AccuracyTable::text(const QString &row, const QString &column) const
{
   const auto *label = findChild<QLabel *>(QStringLiteral("preset.%1.%2").arg(row, column));
   return label ? label->accessibleName() : QString();
}

} // namespace diatom::gui
