// What mouse, wheel and keys do in the 3D view.
#include "gui/viewport.h"

#include <QMouseEvent>

#include <algorithm>

namespace diatom::gui {

namespace {

constexpr double kDragPixels = 4; // desktop.md section 2
constexpr double kArrowReach = 12;

} // namespace

Tool Viewport::toolFor(Qt::KeyboardModifiers keys) const
{
   const Tool tool = m_builder->tool();
   if (keys & Qt::AltModifier)
      return Tool::pick;
   if (keys & Qt::ControlModifier)
      return tool == Tool::erase ? Tool::place : Tool::erase;
   return tool;
}

void Viewport::hover(const QPointF &at, Qt::KeyboardModifiers keys)
{
   if (!m_moved)
      m_builder->hover(rayAt(at), sight(), toolFor(keys));
}

bool Viewport::onArrow(const QPointF &at) const
{
   const auto ends = m_builder->arrow(kArrowPixels * m_camera.metresPerPixel());
   if (!ends)
      return false;
   const auto a = m_camera.project(ends->first), b = m_camera.project(ends->second);
   if (!a || !b)
      return false;
   const Eigen::Vector2d p(at.x(), at.y()), d = *b - *a;
   const double t = std::clamp((p - *a).dot(d) / std::max(d.squaredNorm(), 1e-9), 0.0, 1.0);
   return (p - *a - t * d).norm() < kArrowReach;
}

void Viewport::mousePressEvent(QMouseEvent *event)
{
   if (m_drag != Drag::none)
      return;
   m_drag = Drag::waiting;
   m_button = event->button();
   m_keys = event->modifiers();
   m_pressed = m_last = event->position();
   m_pivot = m_camera.target();
   const render::Ray ray = rayAt(m_pressed);
   if (m_button == Qt::RightButton && m_session->hierarchy())
      if (const auto pick = render::pickPort(*m_session->hierarchy(), ray, sight()); pick && pick->hit)
         m_pivot = pick->hit->point;
   if (m_button == Qt::LeftButton && !m_space && onArrow(m_pressed)) {
      m_drag = Drag::arrow;
      m_builder->beginPull(ray);
   }
}

void Viewport::startDrag(const QPointF &at)
{
   if (m_button == Qt::MiddleButton || (m_button == Qt::LeftButton && m_space)) {
      m_drag = Drag::pan;
      m_spaceUsed = m_space;
   } else if (m_button == Qt::RightButton) {
      m_drag = Drag::orbit;
   } else if (m_button == Qt::LeftButton && (m_keys & Qt::ShiftModifier) && !m_moved) {
      m_drag = Drag::region;
      m_builder->beginRegion(rayAt(m_pressed), sight());
   } else {
      m_drag = Drag::idle;
   }
   dragTo(at);
}

void Viewport::dragTo(const QPointF &at)
{
   const QPointF by = at - m_last;
   m_last = at;
   switch (m_drag) {
   case Drag::orbit:
      m_camera.orbit(by.x(), by.y(), m_pivot);
      break;
   case Drag::pan:
      m_camera.pan(by.x(), by.y());
      break;
   case Drag::region:
      m_builder->dragRegion(rayAt(at));
      break;
   case Drag::arrow:
      m_builder->dragPull(rayAt(at));
      break;
   case Drag::none:
   case Drag::waiting:
   case Drag::idle:
      return;
   }
   update();
}

void Viewport::mouseMoveEvent(QMouseEvent *event)
{
   const QPointF at = event->position();
   if (m_drag == Drag::none) {
      hover(at, event->modifiers() & ~Qt::AltModifier); // Alt may be held for the wheel
      return;
   }
   if (m_drag == Drag::waiting) {
      if ((at - m_pressed).manhattanLength() >= kDragPixels)
         startDrag(at);
      return;
   }
   dragTo(at);
}

void Viewport::mouseReleaseEvent(QMouseEvent *event)
{
   if (event->button() != m_button)
      return;
   const bool click = m_drag == Drag::waiting && m_button == Qt::LeftButton && !m_space;
   m_drag = Drag::none;
   m_button = Qt::NoButton;
   if (!click)
      return;
   if (m_moved) {
      emit failed(tr("Cells can be edited at rest only: press Backspace to return to the start."));
      return;
   }
   hover(m_pressed, m_keys);
   m_builder->act();
   hover(event->position(), event->modifiers() & ~Qt::AltModifier);
}

void Viewport::wheelEvent(QWheelEvent *event)
{
   // Some platforms turn Alt+wheel sideways.
   const double steps = (event->angleDelta().y() + event->angleDelta().x()) / 120.0;
   if (event->modifiers() & Qt::AltModifier) {
      m_builder->cycle(steps > 0 ? 1 : -1);
   } else {
      m_camera.zoom(steps, {event->position().x(), event->position().y()});
      update();
   }
   event->accept();
}

void Viewport::leaveEvent(QEvent *) { m_builder->leave(); }

bool Viewport::event(QEvent *event)
{
   // Space held is for panning; its release without a drag plays. Enter and arrows act here only while a
   // region is open.
   if (event->type() == QEvent::ShortcutOverride && static_cast<QKeyEvent *>(event)->key() == Qt::Key_Space) {
      event->accept();
      return true;
   }
   return QOpenGLWidget::event(event);
}

void Viewport::keyPressEvent(QKeyEvent *event)
{
   switch (event->key()) {
   case Qt::Key_Space:
      if (!event->isAutoRepeat()) {
         m_space = true;
         m_spaceUsed = false;
      }
      break;
   case Qt::Key_Up:
      m_builder->pull(1);
      break;
   case Qt::Key_Down:
      m_builder->pull(-1);
      break;
   default:
      QOpenGLWidget::keyPressEvent(event);
   }
}

void Viewport::keyReleaseEvent(QKeyEvent *event)
{
   if (event->key() != Qt::Key_Space || event->isAutoRepeat()) {
      QOpenGLWidget::keyReleaseEvent(event);
      return;
   }
   if (m_space && !m_spaceUsed)
      emit playWanted();
   m_space = false;
}

} // namespace diatom::gui
