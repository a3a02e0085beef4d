// The colour bar with numbers, laid over the viewport while cells are coloured by a field.
#pragma once

#include "render/color_map.h"

#include <QWidget>

namespace diatom::gui {

class LegendWidget : public QWidget
{
   Q_OBJECT

public:
   explicit LegendWidget(QWidget *parent);
   void setLegend(const render::Legend &legend);
   /// Title and numbers as shown, for screen readers and tests.
   QString text() const;
   QSize sizeHint() const override { return {132, 260}; }

protected:
   void paintEvent(QPaintEvent *event) override;

private:
   render::Legend m_legend;
};

} // namespace diatom::gui
