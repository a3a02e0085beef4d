#include "gui/icons.h"

#include <QGuiApplication>
#include <QIconEngine>
#include <QPainter>
#include <QPainterPath>
#include <QPalette>

#include <functional>

namespace diatom::gui {

namespace {

using Draw = std::function<void(QPainter &, const QColor &ink)>; // on a square of 24

class Engine : public QIconEngine
{
public:
   explicit Engine(Draw draw) : m_draw(std::move(draw)) {}
   void paint(QPainter *painter, const QRect &rect, QIcon::Mode mode, QIcon::State) override
   {
      painter->save();
      painter->setRenderHint(QPainter::Antialiasing);
      painter->translate(rect.topLeft());
      painter->scale(rect.width() / 24.0, rect.height() / 24.0);
      const auto group = mode == QIcon::Disabled ? QPalette::Disabled : QPalette::Active;
      const QColor ink = QGuiApplication::palette().color(group, QPalette::ButtonText);
      painter->setPen(QPen(ink, 1.6, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
      m_draw(*painter, ink);
      painter->restore();
   }
   QPixmap pixmap(const QSize &size, QIcon::Mode mode, QIcon::State state) override
   {
      QPixmap pixmap(size);
      pixmap.fill(Qt::transparent);
      QPainter painter(&pixmap);
      paint(&painter, QRect(QPoint(), size), mode, state);
      return pixmap;
   }
   QIconEngine *clone() const override { return new Engine(*this); }

private:
   Draw m_draw;
};

QIcon icon(Draw draw) { return QIcon(new Engine(std::move(draw))); }

/// A cube seen from a corner, its three faces lit as in the viewport.
void cube(QPainter &p, const QColor &color, const QPointF &at = {10.5, 12}, double r = 8)
{
   const QPointF up(0, -r), right(r * 0.87, -r * 0.5), left(-r * 0.87, -r * 0.5);
   p.setBrush(color.lighter(118));
   p.drawPolygon(QPolygonF{at, at + left, at + left + right, at + right});
   p.setBrush(color);
   p.drawPolygon(QPolygonF{at, at + left, at + left - up, at - up});
   p.setBrush(color.darker(125));
   p.drawPolygon(QPolygonF{at, at + right, at + right - up, at - up});
}

void triangle(QPainter &p, const QColor &ink, double left, double right)
{
   p.setBrush(ink);
   p.drawPolygon(QPolygonF{{left, 5}, {right, 12}, {left, 19}});
}

} // namespace

QIcon materialIcon(const QColor &color)
{
   return icon([color](QPainter &p, const QColor &) {
      p.setPen(QPen(color.darker(180), 1));
      cube(p, color, {12, 12}, 10);
   });
}

QIcon actionIcon(std::string_view id)
{
   const QColor grey(0xb8, 0xc4, 0xd0);
   if (id == "tool.place")
      return icon([grey](QPainter &p, const QColor &) {
         cube(p, grey);
         p.setPen(QPen(QColor(0x1e, 0x6e, 0xdc), 2.6, Qt::SolidLine, Qt::RoundCap));
         p.drawLine(QPointF(19, 14), QPointF(19, 22));
         p.drawLine(QPointF(15, 18), QPointF(23, 18));
      });
   if (id == "tool.erase")
      return icon([grey](QPainter &p, const QColor &) {
         cube(p, grey);
         p.setPen(QPen(QColor(0xc8, 0x3a, 0x34), 2.6, Qt::SolidLine, Qt::RoundCap));
         p.drawLine(QPointF(16, 15), QPointF(22, 21));
         p.drawLine(QPointF(22, 15), QPointF(16, 21));
      });
   if (id == "tool.paint")
      return icon([](QPainter &p, const QColor &ink) {
         cube(p, QColor(0xe8, 0xc2, 0x4a));
         p.setPen(QPen(ink, 2.6, Qt::SolidLine, Qt::RoundCap));
         p.drawLine(QPointF(22, 8), QPointF(17, 16));
      });
   if (id == "tool.pick")
      return icon([](QPainter &p, const QColor &ink) {
         p.drawLine(QPointF(5, 19), QPointF(13, 11));
         p.drawLine(QPointF(11, 9), QPointF(15, 13));
         p.setBrush(ink);
         p.drawEllipse(QPointF(17, 7), 3, 3);
      });
   if (id == "simulate.play")
      return icon([](QPainter &p, const QColor &ink) { triangle(p, ink, 7, 18); });
   if (id == "simulate.reset")
      return icon([](QPainter &p, const QColor &ink) {
         triangle(p, ink, 18, 8);
         p.drawLine(QPointF(6, 5), QPointF(6, 19));
      });
   if (id == "simulate.panel") // a dial
      return icon([](QPainter &p, const QColor &ink) {
         p.drawArc(QRectF(3, 4, 18, 18), -30 * 16, 240 * 16);
         p.drawLine(QPointF(12, 13), QPointF(17, 8));
         p.setBrush(ink);
         p.drawEllipse(QPointF(12, 13), 1.6, 1.6);
      });
   return {};
}

} // namespace diatom::gui
