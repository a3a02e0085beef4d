#include "gui/viewport.h"

#include "render/design_overlay.h"

#include <QOpenGLContext>

#include <algorithm>
#include <cmath>

namespace diatom::gui {

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
   connect(session, &Session::designChanged, this, [this] {
      m_highlight.clear();
      reload();
   });
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
   addHighlight(overlay);
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

void Viewport::setHighlight(std::vector<Index> cells)
{
   m_highlight = std::move(cells);
   update();
}

/// Outlines where the cells are drawn now; not turned with them.
void Viewport::addHighlight(render::Overlay &overlay) const
{
   if (m_highlight.empty() || !m_session->hierarchy())
      return;
   constexpr render::Rgba kColor{0xe0, 0x30, 0xa0, 255};
   const Lattice &lattice = m_session->hierarchy()->lattice();
   for (const Index cell : m_highlight) {
      const std::size_t first = overlay.lines.size();
      render::addCellOutline(overlay, lattice, cell, kColor, 3);
      const Vec3 moved = m_scene.position(cell) - lattice.position(cell);
      for (std::size_t k = first; k < overlay.lines.size(); ++k) {
         overlay.lines[k].a += moved;
         overlay.lines[k].b += moved;
      }
   }
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

void Viewport::showSurface(std::shared_ptr<const render::Surface> surface)
{
   m_scene.setSurface(std::move(surface));
   updateReach();
   update();
}

void Viewport::showReferences(std::shared_ptr<const render::Surface> references)
{
   m_scene.setReferences(std::move(references));
   updateReach();
   update();
}

void Viewport::showFrame(std::shared_ptr<const render::Moment> frame, bool byDisplacement)
{
   const bool moved = frame != nullptr;
   if (moved != m_moved)
      m_builder->leave();
   m_moved = moved;
   if (moved)
      m_scene.setSurface(nullptr);
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

} // namespace diatom::gui
