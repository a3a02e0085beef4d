// Error against the time a run takes, both logarithmic: a dot for each setting, hollow where predicted, a
// ring around the one in force. What is not known is not drawn.
#pragma once

#include "study/accuracy_probe.h"

#include <QWidget>

#include <optional>
#include <vector>

namespace diatom::gui {

class WorkPrecisionPlot : public QWidget
{
   Q_OBJECT

public:
   struct Point
   {
      QString name;
      double seconds = 0, error = 0; // s; relative
      bool measured = false;         // the error
   };

   explicit WorkPrecisionPlot(QWidget *parent);
   void setEstimates(const std::vector<PresetEstimate> &presets, const std::optional<PresetEstimate> &now);
   /// What is drawn, by rising time.
   const std::vector<Point> &points() const { return m_points; }
   const std::optional<Point> &ringed() const { return m_ringed; }
   QSize sizeHint() const override { return {340, 190}; }
   QSize minimumSizeHint() const override { return {240, 170}; }

protected:
   void paintEvent(QPaintEvent *event) override;

private:
   std::vector<Point> m_points;
   std::optional<Point> m_ringed;
};

} // namespace diatom::gui
