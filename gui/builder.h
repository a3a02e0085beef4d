// What the pointer does to a design: hover, click, region. Turns rays into ghosts and into commands; knows no
// widget.
#pragma once

#include "gui/session.h"
#include "render/design_overlay.h"
#include "render/port_picker.h"

#include <QObject>
#include <QString>

#include <optional>

namespace diatom::gui {

enum class Tool { place, erase, paint, pick };

/// What a click would do now.
struct Ghost
{
   bool visible = false;
   Tool tool = Tool::place;
   std::optional<Index> cell; // that would change; nothing on a dead port
   render::Port port;
   int corners = 0; // of the port's outline
   QString problem; // why a click does nothing, e.g. "no neighbour here"
};

class Builder : public QObject
{
   Q_OBJECT

public:
   Builder(Session *session, QObject *parent);

   Tool tool() const { return m_tool; }
   void setTool(Tool tool);
   const Ghost &ghost() const { return m_ghost; }
   const std::optional<Box> &region() const { return m_region; }

   /// `tool` is the one in force with the keys held.
   void hover(const render::Ray &ray, double reach, Tool tool);
   void leave();
   void cycle(int steps);
   /// Does what the ghost shows.
   void act();

   void beginRegion(const render::Ray &ray, double reach);
   void dragRegion(const render::Ray &ray);
   /// Moves the top of the region by layers.
   void pull(int layers);
   void fillRegion();
   void eraseRegion();
   void cancel();
   /// Ends of the arrow that pulls the region's height, m; `length` of the arrow.
   std::optional<std::pair<Vec3, Vec3>> arrow(double length) const;
   void beginPull(const render::Ray &ray);
   void dragPull(const render::Ray &ray);

   void addTo(render::Overlay &overlay, double metresPerPixel) const;
   /// "(4,2,7) face 9", "" over nothing.
   QString address() const;
   /// What a click would do, in words.
   QString hint() const;

signals:
   void changed();
   void toolChanged();

private:
   void showGhost(const render::Port &port, const std::optional<RayHit> &hit);
   nlohmann::json materialName() const;

   Session *m_session;
   Tool m_tool = Tool::place, m_force = Tool::place;
   Ghost m_ghost;
   std::optional<RayHit> m_hit;
   render::Port m_picked; // under the pointer; the ghost's may be another by the wheel
   std::optional<Box> m_region;
   Index m_start;
   double m_planeHeight = 0, m_pullFrom = 0;
   std::int32_t m_pullTop = 0;
};

} // namespace diatom::gui
