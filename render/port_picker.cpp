#include "render/port_picker.h"

#include "render/face_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace diatom::render {

namespace {

const char *word(Contact contact)
{
   return contact == Contact::face ? "face" : contact == Contact::edge ? "edge" : "vertex";
}

/// Ports that a user may attach through: across faces, and wherever the lattice's own connection joins.
bool attaches(const Link &link) { return link.contact == Contact::face || link.joined; }

Port portOf(const Hierarchy &hierarchy, Index cell, const Link &link)
{
   const Index neighbour = cell + link.offset;
   return {cell, link.contact, link.feature, neighbour, !hierarchy.at(neighbour).empty(), false};
}

double distanceToSegment(const Vec3 &p, const Vec3 &a, const Vec3 &b)
{
   const Vec3 d = b - a;
   const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
   return (p - a - t * d).norm();
}

/// How far a point on a face is from an edge or vertex port; infinite when the port is not on that face.
double distanceOnFace(const Lattice &lattice, Index cell, int face, const Link &link, const Vec3 &point)
{
   const int site = lattice.site(cell);
   const Shape &shape = lattice.shape(site);
   const auto &around = shape.faces[static_cast<std::size_t>(face)];
   const auto onFace = [&](int vertex) {
      return std::find(around.begin(), around.end(), vertex) != around.end();
   };
   const auto corner = [&](int vertex) -> Vec3 {
      return lattice.position(cell) + lattice.corners(site)[static_cast<std::size_t>(vertex)];
   };
   if (link.contact == Contact::vertex)
      return onFace(link.feature) ? (point - corner(link.feature)).norm()
                                  : std::numeric_limits<double>::infinity();
   const auto &[a, b] = shape.edges[static_cast<std::size_t>(link.feature)];
   if (!onFace(a) || !onFace(b))
      return std::numeric_limits<double>::infinity();
   return distanceToSegment(point, corner(a), corner(b));
}

Port portOnFace(const Hierarchy &hierarchy, const RayHit &hit)
{
   const Lattice &lattice = hierarchy.lattice();
   const Index cell = hit.found.index;
   const int site = lattice.site(cell);
   if (const Link *across = lattice.acrossFace(site, hit.face))
      return portOf(hierarchy, cell, *across);
   const Link *best = nullptr;
   double least = std::numeric_limits<double>::infinity();
   for (const Link &link : lattice.links(site)) {
      if (link.contact == Contact::face || !attaches(link))
         continue;
      const double distance = distanceOnFace(lattice, cell, hit.face, link, hit.point);
      if (distance < least) {
         least = distance;
         best = &link;
      }
   }
   if (best)
      return portOf(hierarchy, cell, *best);
   return {cell, Contact::face, hit.face, std::nullopt, false, false};
}

} // namespace

std::string text(Index i) { return fmt::format("({},{},{})", i.x, i.y, i.z); }

std::string Port::text() const
{
   return base ? render::text(cell) + " base plane"
               : fmt::format("{} {} {}", render::text(cell), word(contact), feature);
}

std::optional<Pick> pickPort(const Hierarchy &hierarchy, const Ray &ray, double reach)
{
   if (auto hit = hierarchy.hit(ray.origin, ray.direction, reach)) {
      Pick pick;
      pick.port = portOnFace(hierarchy, *hit);
      pick.distance = hit->distance;
      pick.hit = std::move(hit);
      return pick;
   }
   const Lattice &lattice = hierarchy.lattice();
   const auto point = meetPlane(ray, basePlaneHeight(lattice));
   if (!point || (*point - ray.origin).norm() > reach)
      return std::nullopt;
   const Index cell = cellOfLayer(lattice, *point, 0);
   if (!inRange(cell))
      return std::nullopt;
   Pick pick;
   pick.port = {cell, Contact::face, 0, cell, !hierarchy.at(cell).empty(), true};
   pick.distance = (*point - ray.origin).norm();
   return pick;
}

std::vector<Port> portsOf(const Hierarchy &hierarchy, Index cell)
{
   std::vector<Port> ports;
   const Lattice &lattice = hierarchy.lattice();
   for (const Link &link : lattice.links(lattice.site(cell)))
      if (attaches(link) && inRange(cell + link.offset))
         ports.push_back(portOf(hierarchy, cell, link));
   return ports;
}

Port cyclePort(const Hierarchy &hierarchy, const Port &from, int steps)
{
   if (from.base)
      return from;
   const auto ports = portsOf(hierarchy, from.cell);
   // Several neighbours may meet at one corner or edge.
   const auto same = [&](const Port &p) {
      return p.contact == from.contact && p.feature == from.feature && p.neighbour == from.neighbour;
   };
   const auto count = static_cast<int>(ports.size());
   int at = static_cast<int>(std::find_if(ports.begin(), ports.end(), same) - ports.begin());
   if (at == count)
      at = steps > 0 ? -1 : 0;
   const int direction = steps > 0 ? 1 : -1;
   int left = std::abs(steps);
   for (int tried = 0; tried < count && left > 0; ++tried) {
      at = ((at + direction) % count + count) % count;
      if (!ports[static_cast<std::size_t>(at)].occupied)
         --left;
   }
   return left == 0 && at >= 0 && at < count ? ports[static_cast<std::size_t>(at)] : from;
}

std::vector<Vec3> portOutline(const Lattice &lattice, const Port &port)
{
   const int site = lattice.site(port.cell);
   const auto corners = lattice.corners(site);
   const Vec3 centre = lattice.position(port.cell);
   const auto corner = [&](int v) -> Vec3 { return centre + corners[static_cast<std::size_t>(v)]; };
   if (port.base) {
      const Shape &shape = lattice.shape(site);
      // The lowest face, or the lowest corner where the cell stands on its tip.
      std::size_t lowest = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t f = 0; f < shape.faces.size(); ++f) {
         double top = -std::numeric_limits<double>::infinity();
         for (const int v : shape.faces[f])
            top = std::max(top, corner(v).z());
         if (top < least - 1e-9 * lattice.radius()) {
            least = top;
            lowest = f;
         }
      }
      return faceCorners(lattice, port.cell, static_cast<int>(lowest));
   }
   switch (port.contact) {
   case Contact::face:
      return faceCorners(lattice, port.cell, port.feature);
   case Contact::edge: {
      const auto &edge = lattice.shape(site).edges[static_cast<std::size_t>(port.feature)];
      return {corner(edge[0]), corner(edge[1])};
   }
   case Contact::vertex:
      break;
   }
   return {corner(port.feature)};
}

double basePlaneHeight(const Lattice &lattice)
{
   double height = std::numeric_limits<double>::infinity();
   const auto period = lattice.period();
   for (int x = 0; x < period[0]; ++x)
      for (int y = 0; y < period[1]; ++y) {
         const Index i{x, y, 0};
         for (const Vec3 &corner : lattice.corners(lattice.site(i)))
            height = std::min(height, lattice.position(i).z() + corner.z());
      }
   return height;
}

Index cellOfLayer(const Lattice &lattice, const Vec3 &point, std::int32_t layer)
{
   const auto period = lattice.period();
   const Vec3 zero = lattice.position({0, 0, layer});
   const Vec3 stepX = (lattice.position({period[0], 0, layer}) - zero) / period[0];
   const Vec3 stepY = (lattice.position({0, period[1], layer}) - zero) / period[1];
   Eigen::Matrix2d steps;
   steps << stepX.head<2>(), stepY.head<2>();
   const Eigen::Vector2d guess = steps.inverse() * (point - zero).head<2>();
   const auto whole = [](double v) {
      return static_cast<std::int32_t>(
          std::lround(std::clamp(v, -double(kIndexLimit) + 16, double(kIndexLimit) - 16)));
   };
   const Index middle{whole(guess.x()), whole(guess.y()), layer};
   // Offsets of the sites move the nearest one by a period at most.
   Index best = middle;
   double least = std::numeric_limits<double>::infinity();
   for (int dx = -period[0] - 1; dx <= period[0] + 1; ++dx)
      for (int dy = -period[1] - 1; dy <= period[1] + 1; ++dy) {
         const Index i = middle + Index{dx, dy, 0};
         const double distance = (lattice.position(i) - point).head<2>().norm();
         if (distance < least - 1e-9 * lattice.radius()) {
            least = distance;
            best = i;
         }
      }
   return best;
}

double layerHeight(const Lattice &lattice)
{
   const int period = lattice.period()[2];
   return (lattice.position({0, 0, period}) - lattice.position({})).z() / period;
}

std::optional<Vec3> meetPlane(const Ray &ray, double height)
{
   const double distance = (height - ray.origin.z()) / ray.direction.z();
   if (!std::isfinite(distance) || distance <= 0)
      return std::nullopt;
   return ray.at(distance);
}

} // namespace diatom::render
