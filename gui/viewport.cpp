#include "gui/viewport.h"

#include "render/design_overlay.h"

#include <QMouseEvent>
#include <QOpenGLContext>

#include <algorithm>
#include <cmath>

namespace diatom::gui {

namespace {

constexpr double kDragPixels = 4;   // desktop.md section 2
constexpr double kArrowPixels = 60; // the builder's arrow
constexpr double kArrowReach = 12;

} // namespace

Viewport::Viewport(Session *session, QWidget *parent)
    : QOpenGLWidget(parent), m_session(session), m_builder(new Builder(session, this))
{
   setObjectName(QStringLiteral("viewport"));
   setAccessibleName(tr("3D view"));
   setMouseTracking(true);
   setFocusPolicy(Qt::StrongFocus);
   setMinimumSize(320, 240);
   m_camera.look(render::ViewDirection::iso);
   connect(m_builder, &Builder::changed, this, [this] {
      emit hoverChanged();
      update();
   });
   connect(session, &Session::designChanged, this, &Viewport::reload);
   connect(session, &Session::designReplaced, this, [this] {
      m_fitWanted = true;
      update();
   });
   reload();
}

Viewport::~Viewport()
{
   makeCurrent();
   m_renderer.reset();
   doneCurrent();
}

void Viewport::initializeGL()
{
   m_renderer = std::make_unique<render::Renderer>();
   if (const Status status = m_renderer->start(); !status) {
      emit failed(QString::fromStdString(status.error().message));
      m_renderer.reset();
      return;
   }
   m_device = QString::fromStdString(m_renderer->device());
   reload(); // a new context (the window moved to another one) starts empty
}

void Viewport::resizeGL(int width, int height)
{
   m_camera.resize(width, height);
   if (m_fitWanted)
      fit();
}

void Viewport::paintGL()
{
   if (!m_renderer)
      return;
   QElapsedTimer clock;
   clock.start();
   if (m_fitWanted)
      fit();
   m_scene.upload(*m_renderer);
   render::Overlay overlay;
   if (!m_moved)
      m_builder->addTo(overlay, m_camera.metresPerPixel());
   render::addTriad(overlay, m_camera);
   m_renderer->setOverlay(overlay);
   const double scale = devicePixelRatioF();
   const int samples = m_renderer->software() ? 0 : 4;
   const Status status =
       m_renderer->draw(m_camera, {static_cast<int>(std::lround(width() * scale)),
                                   static_cast<int>(std::lround(height() * scale)), scale, samples});
   if (status)
      m_renderer->copyTo(defaultFramebufferObject());
   else
      emit failed(QString::fromStdString(status.error().message));
   m_drawSeconds = static_cast<double>(clock.nsecsElapsed()) * 1e-9;
   ++m_frameId;
   emit framePainted();
}

void Viewport::reload()
{
   m_scene.setDesign(m_session->hierarchy(), m_hierarchyView, m_grid);
   m_moved = false;
   updateReach();
   update();
}

void Viewport::updateReach() { m_camera.setReach(m_scene.reach()); }

void Viewport::look(render::ViewDirection direction)
{
   m_camera.look(direction);
   fit();
   m_builder->leave();
}

void Viewport::fit()
{
   m_fitWanted = false;
   render::Bounds bounds = m_scene.bounds();
   if (bounds.isEmpty() && m_session->hierarchy()) // room for a first few cells
      bounds = render::worldBounds(m_session->hierarchy()->lattice(), {{-2, -2, 0}, {2, 2, 1}});
   m_camera.fit(bounds);
   update();
}

void Viewport::setOrthographic(bool on)
{
   m_camera.setOrthographic(on);
   update();
}

void Viewport::setHierarchyView(bool on)
{
   m_hierarchyView = on;
   reload();
}

void Viewport::setGrid(bool on)
{
   m_grid = on;
   reload();
}

void Viewport::showFrame(std::shared_ptr<const render::Moment> frame, bool byDisplacement)
{
   const bool moved = frame != nullptr;
   if (moved != m_moved)
      m_builder->leave();
   m_moved = moved;
   m_scene.setFrame(std::move(frame), byDisplacement);
   update();
}

std::optional<QPointF> Viewport::onScreen(const Vec3 &point) const
{
   const auto at = m_camera.project(point);
   return at ? std::optional(QPointF(at->x(), at->y())) : std::nullopt;
}

std::optional<QPointF> Viewport::screenPos(Index cell) const { return onScreen(m_scene.position(cell)); }

std::optional<QPointF> Viewport::screenPos(Index cell, Contact contact, int feature) const
{
   render::Port port;
   port.cell = cell;
   port.contact = contact;
   port.feature = feature;
   const auto corners = render::portOutline(m_session->hierarchy()->lattice(), port);
   Vec3 middle = Vec3::Zero();
   for (const Vec3 &corner : corners)
      middle += corner / double(corners.size());
   return onScreen(middle);
}

std::optional<QPointF> Viewport::screenPosBase(Index cell) const
{
   const Lattice &lattice = m_session->hierarchy()->lattice();
   Vec3 point = lattice.position(cell);
   point.z() = render::basePlaneHeight(lattice);
   return onScreen(point);
}

std::optional<QPointF> Viewport::screenPosArrow() const
{
   const auto ends = m_builder->arrow(kArrowPixels * m_camera.metresPerPixel());
   return ends ? onScreen((ends->first + ends->second) / 2) : std::nullopt;
}

/// As far as a ray looks for cells: everything in front of the eye.
double Viewport::sight() const
{
   const render::Bounds reach = m_scene.reach();
   const double around =
       reach.isEmpty() ? 0 : (reach.center() - m_camera.eye()).norm() + reach.diagonal().norm();
   return 2 * std::max(around, 10 * m_camera.distance());
}

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
