#include "gui/builder.h"

#include <algorithm>
#include <cmath>

namespace diatom::gui {

namespace {

constexpr render::Rgba kAdd{30, 110, 220, 255}, kErase{200, 50, 45, 255}, kPaint{190, 140, 10, 255};

QString sizeText(const Box &box)
{
   const auto span = [](std::int32_t low, std::int32_t high) { return QString::number(high - low + 1); };
   return span(box.min.x, box.max.x) + QLatin1Char('x') + span(box.min.y, box.max.y) + QLatin1Char('x') +
          span(box.min.z, box.max.z);
}

nlohmann::json asJson(Index i) { return {i.x, i.y, i.z}; }
nlohmann::json asJson(const Box &box) { return {asJson(box.min), asJson(box.max)}; }

/// Height at which a ray passes closest to a vertical line.
double heightAlong(const render::Ray &ray, const Vec3 &foot)
{
   const Vec3 d = ray.direction, w = ray.origin - foot;
   const double level = 1 - d.z() * d.z();
   return level < 1e-9 ? foot.z() : foot.z() + w.z() - d.z() * (d.dot(w) - d.z() * w.z()) / level;
}

} // namespace

Builder::Builder(Session *session, QObject *parent) : QObject(parent), m_session(session)
{
   connect(session, &Session::designChanged, this, &Builder::leave);
   connect(session, &Session::designReplaced, this, &Builder::cancel);
   connect(session, &Session::materialChanged, this, &Builder::changed);
}

void Builder::setTool(Tool tool)
{
   m_tool = m_force = tool;
   emit toolChanged();
   leave();
}

void Builder::hover(const render::Ray &ray, double reach, Tool tool)
{
   const auto &hierarchy = m_session->hierarchy();
   const auto pick = hierarchy ? render::pickPort(*hierarchy, ray, reach) : std::nullopt;
   if (!pick && !m_ghost.visible)
      return;
   // A port chosen with the wheel stays while the pointer is on the same port.
   if (pick && m_ghost.visible && tool == m_force && pick->port == m_picked)
      return;
   m_force = tool;
   m_hit.reset();
   m_ghost = {};
   if (pick) {
      m_picked = pick->port;
      showGhost(pick->port, pick->hit);
   }
   emit changed();
}

void Builder::leave()
{
   m_ghost = {};
   m_hit.reset();
   emit changed();
}

void Builder::showGhost(const render::Port &port, const std::optional<RayHit> &hit)
{
   m_hit = hit;
   m_ghost = {};
   m_ghost.visible = true;
   m_ghost.tool = m_force;
   m_ghost.port = port;
   m_ghost.corners = static_cast<int>(render::portOutline(m_session->hierarchy()->lattice(), port).size());
   if (m_force != Tool::place) {
      if (hit)
         m_ghost.cell = hit->found.index;
      else
         m_ghost.problem = tr("no cell here");
   } else if (!port.neighbour) {
      m_ghost.problem = tr("no neighbour here");
   } else if (port.occupied) {
      m_ghost.problem = tr("occupied");
   } else {
      m_ghost.cell = port.neighbour;
   }
}

void Builder::cycle(int steps)
{
   if (!m_ghost.visible || m_ghost.port.base || m_force != Tool::place || !m_session->hierarchy())
      return;
   const auto hit = m_hit;
   showGhost(render::cyclePort(*m_session->hierarchy(), m_ghost.port, steps), hit);
   emit changed();
}

nlohmann::json Builder::materialName() const
{
   const MaterialIndex material = m_session->material();
   return material ? m_session->design().model.material(material).id : std::string();
}

void Builder::act()
{
   if (!m_ghost.visible || !m_ghost.cell)
      return;
   const Index cell = *m_ghost.cell;
   switch (m_ghost.tool) {
   case Tool::place:
      m_session->run("place", {{"cell", asJson(cell)}, {"material", materialName()}});
      break;
   case Tool::erase:
      m_session->run("erase", {{"cell", asJson(cell)}});
      break;
   case Tool::paint:
      m_session->run("paint", {{"cell", asJson(cell)}, {"material", materialName()}});
      break;
   case Tool::pick:
      m_session->setMaterial(m_session->hierarchy()->at(cell).material);
      break;
   }
}

void Builder::beginRegion(const render::Ray &ray, double reach)
{
   const auto &hierarchy = m_session->hierarchy();
   const auto pick = hierarchy ? render::pickPort(*hierarchy, ray, reach) : std::nullopt;
   if (!pick)
      return;
   m_start = m_tool == Tool::place && pick->port.neighbour ? *pick->port.neighbour : pick->port.cell;
   m_planeHeight = ray.at(pick->distance).z();
   m_region = Box{m_start, m_start};
   leave();
}

void Builder::dragRegion(const render::Ray &ray)
{
   const auto point = render::meetPlane(ray, m_planeHeight);
   if (!m_region || !point)
      return;
   const Index to = render::cellOfLayer(m_session->hierarchy()->lattice(), *point, m_start.z);
   if (!inRange(to))
      return;
   Box box;
   box.extend(m_start);
   box.extend(to);
   m_region = box;
   emit changed();
}

void Builder::pull(int layers)
{
   if (!m_region)
      return;
   m_region->max.z = std::clamp(m_region->max.z + layers, m_region->min.z, kIndexLimit);
   emit changed();
}

void Builder::fillRegion()
{
   if (m_region && m_session->run("fill", {{"box", asJson(*m_region)}, {"material", materialName()}}))
      cancel();
}

void Builder::eraseRegion()
{
   if (m_region && m_session->run("erase-box", {{"box", asJson(*m_region)}}))
      cancel();
}

void Builder::cancel()
{
   m_region.reset();
   leave();
}

std::optional<std::pair<Vec3, Vec3>> Builder::arrow(double length) const
{
   if (!m_region || !m_session->hierarchy())
      return std::nullopt;
   const Lattice &lattice = m_session->hierarchy()->lattice();
   const Index low{m_region->min.x, m_region->min.y, m_region->max.z};
   Vec3 foot = (lattice.position(low) + lattice.position(m_region->max)) / 2;
   double top = foot.z();
   for (const Vec3 &corner : lattice.corners(lattice.site(m_region->max)))
      top = std::max(top, lattice.position(m_region->max).z() + corner.z());
   foot.z() = top;
   return std::pair{foot, Vec3(foot + length * Vec3::UnitZ())};
}

void Builder::beginPull(const render::Ray &ray)
{
   if (const auto ends = arrow(0)) {
      m_pullFrom = heightAlong(ray, ends->first);
      m_pullTop = m_region->max.z;
   }
}

void Builder::dragPull(const render::Ray &ray)
{
   const auto ends = arrow(0);
   if (!ends)
      return;
   const double layers =
       (heightAlong(ray, ends->first) - m_pullFrom) / render::layerHeight(m_session->hierarchy()->lattice());
   const auto rise = static_cast<std::int32_t>(std::lround(std::clamp(layers, -1e6, 1e6)));
   pull(m_pullTop + rise - m_region->max.z);
}

void Builder::addTo(render::Overlay &overlay, double metresPerPixel) const
{
   if (!m_session->hierarchy())
      return;
   const Lattice &lattice = m_session->hierarchy()->lattice();
   if (m_region) {
      render::addRegion(overlay, lattice, *m_region, kAdd);
      const auto [foot, tip] = *arrow(60 * metresPerPixel);
      const double head = 9 * metresPerPixel;
      overlay.lines.push_back({foot, tip, kAdd, 3});
      for (const Vec3 &side : {Vec3(1, 0, 0), Vec3(0, 1, 0)})
         for (const double sign : {-1.0, 1.0})
            overlay.lines.push_back(
                {tip, Vec3(tip + sign * head * side - 1.6 * head * Vec3::UnitZ()), kAdd, 3});
   }
   if (!m_ghost.visible)
      return;
   const auto color = m_ghost.tool == Tool::erase ? kErase : m_ghost.tool == Tool::place ? kAdd : kPaint;
   if (!m_ghost.cell) {
      render::addPort(overlay, lattice, m_ghost.port, kErase, true);
      return;
   }
   if (m_ghost.tool == Tool::place || m_ghost.tool == Tool::paint) {
      const auto &rgb = m_session->design().model.material(m_session->material()).color;
      render::addGhost(overlay, lattice, *m_ghost.cell, {rgb[0], rgb[1], rgb[2], 185}, color);
   } else if (m_ghost.tool == Tool::erase) {
      render::addGhost(overlay, lattice, *m_ghost.cell, {kErase.r, kErase.g, kErase.b, 120}, kErase);
   }
   if (m_ghost.tool == Tool::place)
      render::addPort(overlay, lattice, m_ghost.port, color, false);
   else
      render::addCellOutline(overlay, lattice, *m_ghost.cell, color, 2.5f);
}

QString Builder::address() const
{
   return m_ghost.visible ? QString::fromStdString(m_ghost.port.text()) : QString();
}

QString Builder::hint() const
{
   if (m_region)
      return tr("Region %1. Drag the arrow or press Up and Down for its height; Enter fills, Delete erases, "
                "Esc drops.")
          .arg(sizeText(*m_region));
   if (!m_ghost.visible)
      return {};
   if (!m_ghost.cell)
      return m_ghost.problem;
   const QString cell = QString::fromStdString(render::text(*m_ghost.cell));
   switch (m_ghost.tool) {
   case Tool::place:
      return tr("Click: place %1 on %2. Alt+wheel: another port.").arg(cell, address());
   case Tool::erase:
      return tr("Click: erase %1.").arg(cell);
   case Tool::paint:
      return tr("Click: paint %1.").arg(cell);
   case Tool::pick:
      return tr("Click: take the material of %1.").arg(cell);
   }
   return {};
}

} // namespace diatom::gui
