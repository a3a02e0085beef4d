#include "gui/work_precision_plot.h"

#include "gui/readable.h"

#include <QPainter>

#include <algorithm>
#include <cmath>

namespace diatom::gui {

namespace {

std::optional<WorkPrecisionPlot::Point> pointOf(const PresetEstimate &estimate)
{
   const double seconds = estimate.seconds.value, error = estimate.error.value;
   const bool known = estimate.seconds.how != Knowledge::unknown && estimate.error.how != Knowledge::unknown;
   if (!known || !std::isfinite(seconds) || !std::isfinite(error) || seconds <= 0 || error <= 0)
      return std::nullopt;
   return WorkPrecisionPlot::Point{QString::fromStdString(estimate.name), seconds, error,
                                   estimate.error.how == Knowledge::measured};
}

/// A logarithmic axis over whole decades.
class Axis
{
public:
   Axis(double low, double high, double from, double to) : m_from(from), m_to(to)
   {
      m_low = static_cast<int>(std::floor(std::log10(low) - 0.05));
      m_high = static_cast<int>(std::ceil(std::log10(high) + 0.05));
   }
   double at(double value) const
   {
      return m_from + (m_to - m_from) * (std::log10(value) - m_low) / (m_high - m_low);
   }
   int low() const { return m_low; }
   int high() const { return m_high; }
   /// Decades between labels, so that they do not run into each other.
   int stride(double room) const
   {
      return std::max(1, static_cast<int>(std::ceil((m_high - m_low) * room / std::abs(m_to - m_from))));
   }

private:
   double m_from, m_to;
   int m_low, m_high;
};

} // namespace

WorkPrecisionPlot::WorkPrecisionPlot(QWidget *parent) : QWidget(parent)
{
   setObjectName(QStringLiteral("workPrecisionPlot"));
   setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
   setEstimates({}, {});
}

void WorkPrecisionPlot::setEstimates(const std::vector<PresetEstimate> &presets,
                                     const std::optional<PresetEstimate> &now)
{
   m_points.clear();
   for (const PresetEstimate &preset : presets)
      if (auto point = pointOf(preset))
         m_points.push_back(*std::move(point));
   std::sort(m_points.begin(), m_points.end(),
             [](const Point &a, const Point &b) { return a.seconds < b.seconds; });
   m_ringed = now ? pointOf(*now) : std::nullopt;
   QString text = tr("Error against the time a run takes.");
   for (const Point &point : m_points)
      text += QStringLiteral(" %1: %2, %3.")
                  .arg(point.name, percentText(point.error), durationText(point.seconds));
   setAccessibleName(text);
   setToolTip(m_points.empty() ? QString()
                               : tr("Lower is more accurate, right is slower. Full dots are measured, hollow "
                                    "ones predicted; the ring is the setting in force."));
   update();
}

void WorkPrecisionPlot::paintEvent(QPaintEvent *)
{
   QPainter painter(this);
   painter.setRenderHint(QPainter::Antialiasing);
   painter.fillRect(rect(), palette().base());
   const QColor ink = palette().color(QPalette::Text), faint = palette().color(QPalette::Mid);
   const QColor blue(0x1e, 0x6e, 0xdc), orange(0xd9, 0x6b, 0x0b);
   painter.setPen(ink);
   if (m_points.empty()) {
      painter.drawText(rect().adjusted(16, 8, -16, -8), Qt::AlignCenter | Qt::TextWordWrap,
                       tr("Nothing to draw: no error is known."));
      return;
   }
   std::vector<Point> all = m_points;
   if (m_ringed)
      all.push_back(*m_ringed);
   double lowX = all.front().seconds, highX = lowX, lowY = all.front().error, highY = lowY;
   for (const Point &point : all) {
      lowX = std::min(lowX, point.seconds);
      highX = std::max(highX, point.seconds);
      lowY = std::min(lowY, point.error);
      highY = std::max(highY, point.error);
   }
   QFont small = font();
   small.setPointSizeF(0.85 * font().pointSizeF());
   painter.setFont(small);
   const QRectF field(74, 12, width() - 74 - 18, height() - 12 - 40);
   const Axis x(lowX, highX, field.left(), field.right()), y(lowY, highY, field.bottom(), field.top());
   for (int k = x.low(); k <= x.high(); k += x.stride(52)) {
      const double at = x.at(std::pow(10, k));
      painter.setPen(faint);
      painter.drawLine(QPointF(at, field.top()), QPointF(at, field.bottom()));
      painter.setPen(ink);
      painter.drawText(QRectF(at - 40, field.bottom() + 3, 80, 16), Qt::AlignHCenter | Qt::AlignTop,
                       figureText(std::pow(10, k)));
   }
   for (int k = y.low(); k <= y.high(); k += y.stride(20)) {
      const double at = y.at(std::pow(10, k));
      painter.setPen(faint);
      painter.drawLine(QPointF(field.left(), at), QPointF(field.right(), at));
      painter.setPen(ink);
      painter.drawText(QRectF(18, at - 8, field.left() - 22, 16), Qt::AlignRight | Qt::AlignVCenter,
                       figureText(std::pow(10, k + 2)));
   }
   painter.drawText(QRectF(field.left(), height() - 19, field.width(), 17), Qt::AlignCenter,
                    tr("This run takes (s)"));
   painter.save();
   painter.translate(2, field.center().y());
   painter.rotate(-90);
   painter.drawText(QRectF(-field.height() / 2 - 8, 0, field.height() + 16, 16), Qt::AlignCenter,
                    tr("Error (%)"));
   painter.restore();

   painter.setPen(QPen(blue, 1.2));
   for (std::size_t k = 1; k < m_points.size(); ++k)
      painter.drawLine(QPointF(x.at(m_points[k - 1].seconds), y.at(m_points[k - 1].error)),
                       QPointF(x.at(m_points[k].seconds), y.at(m_points[k].error)));
   const QFontMetricsF metrics(small);
   for (const Point &point : m_points) {
      const QPointF at(x.at(point.seconds), y.at(point.error));
      painter.setPen(QPen(blue, 1.6));
      painter.setBrush(point.measured ? QBrush(blue) : QBrush(palette().color(QPalette::Base)));
      painter.drawEllipse(at, 4, 4);
      const double wide = metrics.horizontalAdvance(point.name);
      const bool left = at.x() + 9 + wide > field.right();
      painter.setPen(ink);
      painter.drawText(QPointF(left ? at.x() - 9 - wide : at.x() + 9, at.y() - 5), point.name);
   }
   if (m_ringed) {
      painter.setPen(QPen(orange, 2.2));
      painter.setBrush(Qt::NoBrush);
      painter.drawEllipse(QPointF(x.at(m_ringed->seconds), y.at(m_ringed->error)), 8, 8);
   }
}

} // namespace diatom::gui
