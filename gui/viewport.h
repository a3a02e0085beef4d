// The 3D view: draws the scene and turns mouse, wheel and keys into camera moves and into the builder's acts.
#pragma once

#include "gui/builder.h"
#include "gui/session.h"
#include "render/camera.h"
#include "render/renderer.h"
#include "render/scene_view.h"

#include <QElapsedTimer>
#include <QOpenGLWidget>

#include <memory>
#include <optional>

namespace diatom::gui {

class Viewport : public QOpenGLWidget
{
   Q_OBJECT

public:
   explicit Viewport(Session *session, QWidget *parent = nullptr);
   ~Viewport() override;

   Builder &builder() { return *m_builder; }
   void look(render::ViewDirection direction);
   void fit();
   void setOrthographic(bool on);
   void setHierarchyView(bool on);
   void setGrid(bool on);
   /// Parts or struts in the place of cells, until the design changes or moves; null draws cells.
   void showSurface(std::shared_ptr<const render::Surface> surface);
   /// Meshes beside the cells; null shows none.
   void showReferences(std::shared_ptr<const render::Surface> references);
   /// Null: at rest.
   void showFrame(std::shared_ptr<const render::Moment> frame, bool byDisplacement);
   /// Cells to outline until others are, or the design changes.
   void setHighlight(std::vector<Index> cells);

   // For tests and the status bar; read only.
   const Ghost &ghost() const { return m_builder->ghost(); }
   const std::vector<Index> &highlight() const { return m_highlight; }
   quint64 frameId() const { return m_frameId; }
   /// Where a cell's centre, or the middle of one of its ports, appears; nothing when behind the eye.
   std::optional<QPointF> screenPos(Index cell) const;
   std::optional<QPointF> screenPos(Index cell, Contact contact, int feature) const;
   std::optional<QPointF> screenPosBase(Index cell) const;
   std::optional<QPointF> screenPosArrow() const;
   Vec3 cellPosition(Index cell) const { return m_scene.position(cell); }
   const render::Camera &camera() const { return m_camera; }
   const render::SceneView &scene() const { return m_scene; }
   double drawSeconds() const { return m_drawSeconds; }
   QString device() const { return m_device; }

signals:
   void hoverChanged();
   void playWanted();
   void framePainted();
   void failed(const QString &message);

protected:
   void initializeGL() override;
   void resizeGL(int width, int height) override;
   void paintGL() override;
   bool event(QEvent *event) override;
   void mousePressEvent(QMouseEvent *event) override;
   void mouseMoveEvent(QMouseEvent *event) override;
   void mouseReleaseEvent(QMouseEvent *event) override;
   void wheelEvent(QWheelEvent *event) override;
   void leaveEvent(QEvent *event) override;
   void keyPressEvent(QKeyEvent *event) override;
   void keyReleaseEvent(QKeyEvent *event) override;

private:
   static constexpr double kArrowPixels = 60; // the builder's arrow

   enum class Drag { none, waiting, orbit, pan, region, arrow, idle };

   void reload();
   void addHighlight(render::Overlay &overlay) const;
   void updateReach();
   void startDrag(const QPointF &at);
   void dragTo(const QPointF &at);
   void hover(const QPointF &at, Qt::KeyboardModifiers keys);
   Tool toolFor(Qt::KeyboardModifiers keys) const;
   render::Ray rayAt(const QPointF &at) const { return m_camera.ray({at.x(), at.y()}); }
   double sight() const;
   bool onArrow(const QPointF &at) const;
   std::optional<QPointF> onScreen(const Vec3 &point) const;

   Session *m_session;
   Builder *m_builder;
   render::SceneView m_scene;
   render::Camera m_camera;
   std::unique_ptr<render::Renderer> m_renderer;
   Drag m_drag = Drag::none;
   Qt::MouseButton m_button = Qt::NoButton;
   Qt::KeyboardModifiers m_keys;
   QPointF m_pressed, m_last;
   Vec3 m_pivot = Vec3::Zero();
   std::vector<Index> m_highlight;
   bool m_hierarchyView = false, m_grid = true, m_space = false, m_spaceUsed = false, m_fitWanted = true;
   bool m_moved = false; // a simulation is shown: no building
   quint64 m_frameId = 0;
   double m_drawSeconds = 0;
   QString m_device;
};

} // namespace diatom::gui
