#include "gui/legend_widget.h"

#include <QPainter>

namespace diatom::gui {

LegendWidget::LegendWidget(QWidget *parent) : QWidget(parent)
{
   setObjectName(QStringLiteral("legend"));
   setAttribute(Qt::WA_TransparentForMouseEvents);
   resize(LegendWidget::sizeHint());
   hide();
}

void LegendWidget::setLegend(const render::Legend &legend)
{
   m_legend = legend;
   setAccessibleName(text());
   update();
}

QString LegendWidget::text() const
{
   QString all = QString::fromStdString(m_legend.title);
   for (const std::string &number : m_legend.texts)
      all += QLatin1Char(' ') + QString::fromStdString(number);
   return all;
}

void LegendWidget::paintEvent(QPaintEvent *)
{
   QPainter painter(this);
   painter.setRenderHint(QPainter::Antialiasing);
   painter.setPen(Qt::NoPen);
   painter.setBrush(QColor(255, 255, 255, 205));
   painter.drawRoundedRect(rect(), 6, 6);
   const QColor ink(30, 36, 44);
   painter.setPen(ink);
   painter.drawText(QRect(8, 6, width() - 16, 20), Qt::AlignLeft | Qt::AlignVCenter,
                    QString::fromStdString(m_legend.title));
   const QRect bar(14, 38, 18, height() - 54);
   QLinearGradient gradient(bar.bottomLeft(), bar.topLeft());
   for (int i = 0; i <= 16; ++i) {
      const auto c = render::fieldColor(i / 16.0);
      gradient.setColorAt(i / 16.0, QColor(c.r, c.g, c.b));
   }
   painter.fillRect(bar, gradient);
   for (std::size_t i = 0; i < m_legend.ticks.size(); ++i) {
      const double range = m_legend.high - m_legend.low;
      const double fraction = range > 0 ? (m_legend.ticks[i] - m_legend.low) / range : 0;
      const double y = bar.bottom() + 1 - fraction * bar.height();
      painter.drawLine(QPointF(bar.right() + 1, y), QPointF(bar.right() + 6, y));
      painter.drawText(QRectF(bar.right() + 10, y - 9, 80, 18), Qt::AlignLeft | Qt::AlignVCenter,
                       QString::fromStdString(m_legend.texts[i]));
   }
}

} // namespace diatom::gui
