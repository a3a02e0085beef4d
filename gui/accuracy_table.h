// Presets of accuracy, one a row: step, error and time of the run, each with how it is known. A click on a
// name asks for that step.
#pragma once

#include "study/accuracy_probe.h"

#include <QWidget>

#include <array>
#include <optional>

class QGridLayout;
class QLabel;
class QPushButton;

namespace diatom::gui {

class AccuracyTable : public QWidget
{
   Q_OBJECT

public:
   explicit AccuracyTable(QWidget *parent);

   /// `now` is the setting in force, where its step is known. No presets: every cell is a dash.
   void setEstimates(const std::vector<PresetEstimate> &presets, const std::optional<PresetEstimate> &now);
   /// A cell's text as read aloud, for tests: columns "step", "error", "seconds".
   QString text(const QString &row, const QString &column) const;

signals:
   void applied(double step); // s

private:
   struct Row
   {
      QPushButton *button = nullptr; // of a preset
      QLabel *step = nullptr, *error = nullptr, *seconds = nullptr;
      double asked = 0; // s, the preset's step
   };
   Row makeRow(QGridLayout *grid, int row, const QString &id);
   void fill(Row &row, const PresetEstimate *estimate);

   std::array<Row, kPresets.size()> m_rows;
   Row m_now;
};

} // namespace diatom::gui
