#include "render/design_overlay.h"

#include "render/cell_mesh.h"
#include "render/face_types.h"
#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace diatom::render {

namespace {

/// Counter-clockwise convex hull of points seen from above (monotone chain).
std::vector<Vec3> hullFromAbove(std::vector<Vec3> points)
{
   std::sort(points.begin(), points.end(),
             [](const Vec3 &a, const Vec3 &b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
   std::vector<Vec3> hull;
   const auto half = [&](auto begin, auto end) {
      const std::size_t base = hull.size();
      for (auto p = begin; p != end; ++p) {
         while (hull.size() >= base + 2) {
            const Vec3 u = hull.back() - hull[hull.size() - 2], v = *p - hull.back();
            if (u.x() * v.y() - u.y() * v.x() > 1e-9 * u.norm() * v.norm())
               break;
            hull.pop_back();
         }
         hull.push_back(*p);
      }
      hull.pop_back();
   };
   half(points.begin(), points.end());
   half(points.rbegin(), points.rend());
   return hull;
}

Rgba shaded(Rgba color, const Vec3 &normal)
{
   const double s = shade(normal);
   const auto dim = [s](std::uint8_t v) { return static_cast<std::uint8_t>(std::clamp(v * s, 0.0, 255.0)); };
   return {dim(color.r), dim(color.g), dim(color.b), color.a};
}

} // namespace

std::vector<Line> baseGrid(const Lattice &lattice, const Box &content, Rgba color)
{
   constexpr std::int32_t margin = 6, widest = 48;
   const auto range = [&](std::int32_t low, std::int32_t high) {
      const std::int32_t middle = low + (high - low) / 2;
      const std::int32_t half = std::min(widest, (high - low) / 2 + margin);
      return std::pair{std::max(-kIndexLimit, middle - half), std::min(kIndexLimit, middle + half)};
   };
   const Box box = content.empty() ? Box{{-4, -4, 0}, {4, 4, 0}} : content;
   const auto [x0, x1] = range(box.min.x, box.max.x);
   const auto [y0, y1] = range(box.min.y, box.max.y);
   const double height = basePlaneHeight(lattice);
   std::vector<Line> lines;
   const Vec3 middle = (lattice.position({x0, y0, 0}) + lattice.position({x1, y1, 0})) / 2;
   const double reach =
       (lattice.position({x1, y1, 0}) - lattice.position({x0, y0, 0})).norm() / 2 + lattice.radius();
   for (std::int32_t x = x0; x <= x1; ++x)
      for (std::int32_t y = y0; y <= y1; ++y) {
         const Index i{x, y, 0};
         const Vec3 centre = lattice.position(i);
         std::vector<Vec3> points;
         for (const Vec3 &corner : lattice.corners(lattice.site(i)))
            points.emplace_back(centre.x() + corner.x(), centre.y() + corner.y(), height);
         const double far = (centre - middle).head<2>().norm() / reach;
         Rgba faded = color;
         faded.a = static_cast<std::uint8_t>(color.a * std::clamp(1.15 - far, 0.0, 1.0));
         addLoop(lines, hullFromAbove(std::move(points)), faded, 1);
      }
   return lines;
}

void addGhost(Overlay &overlay, const Lattice &lattice, Index cell, Rgba color, Rgba edge)
{
   const Shape &shape = lattice.shape(lattice.site(cell));
   for (std::size_t face = 0; face < shape.faces.size(); ++face) {
      auto corners = faceCorners(lattice, cell, static_cast<int>(face));
      const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[1]).normalized();
      overlay.ghost.push_back({std::move(corners), shaded(color, normal)});
   }
   addCellOutline(overlay, lattice, cell, edge, 1.4f);
}

void addCellOutline(Overlay &overlay, const Lattice &lattice, Index cell, Rgba color, float width)
{
   const int site = lattice.site(cell);
   const auto corners = lattice.corners(site);
   const Vec3 centre = lattice.position(cell);
   for (const auto &[a, b] : lattice.shape(site).edges)
      overlay.lines.push_back({centre + corners[static_cast<std::size_t>(a)],
                               centre + corners[static_cast<std::size_t>(b)], color, width});
}

void addPort(Overlay &overlay, const Lattice &lattice, const Port &port, Rgba color, bool dead)
{
   const auto outline = portOutline(lattice, port);
   if (outline.size() == 1) {
      const double arm = 0.2 * lattice.radius();
      for (int axis = 0; axis < 3; ++axis)
         overlay.lines.push_back(
             {outline[0] - arm * Vec3::Unit(axis), outline[0] + arm * Vec3::Unit(axis), color, 3});
      return;
   }
   if (outline.size() == 2) {
      overlay.lines.push_back({outline[0], outline[1], color, 4});
      return;
   }
   addLoop(overlay.lines, outline, color, 3);
   if (dead)
      addHatch(overlay.lines, outline, 0.22 * lattice.radius(), color, 1.5f);
}

void addRegion(Overlay &overlay, const Lattice &lattice, const Box &region, Rgba color)
{
   // Tight about the cells' bodies: their corners reach less far than the ball that worldBounds() allows for.
   const auto bodies = [&](Index i, Bounds &bounds) {
      for (const Vec3 &corner : lattice.corners(lattice.site(i)))
         bounds.extend(lattice.position(i) + corner);
   };
   Bounds bounds;
   const auto near = [](std::int32_t low, std::int32_t high, std::int32_t step, int k) {
      return k < step ? std::min(high, low + k) : std::max(low, high - (k - step));
   };
   const auto p = lattice.period();
   for (int x = 0; x < 2 * p[0]; ++x)
      for (int y = 0; y < 2 * p[1]; ++y)
         for (int z = 0; z < 2 * p[2]; ++z)
            bodies({near(region.min.x, region.max.x, p[0], x), near(region.min.y, region.max.y, p[1], y),
                    near(region.min.z, region.max.z, p[2], z)},
                   bounds);
   addBox(overlay.lines, bounds.min(), bounds.max(), color, 2);
}

void addTriad(Overlay &overlay, const Camera &camera)
{
   constexpr double size = 34;
   const Vec3 origin(52, camera.height() - 52, 0);
   struct Axis
   {
      Vec3 direction;
      Rgba color;
      const char *name;
   };
   std::vector<Axis> axes{{Vec3::UnitX(), {200, 55, 50, 255}, "X"},
                          {Vec3::UnitY(), {50, 140, 60, 255}, "Y"},
                          {Vec3::UnitZ(), {45, 95, 200, 255}, "Z"}};
   std::sort(axes.begin(), axes.end(), [&](const Axis &a, const Axis &b) {
      return a.direction.dot(camera.backward()) < b.direction.dot(camera.backward());
   });
   for (const Axis &axis : axes) {
      const auto onScreen = [&](double length) {
         return Vec3(origin +
                     length * Vec3(axis.direction.dot(camera.right()), -axis.direction.dot(camera.up()), 0));
      };
      overlay.screenLines.push_back({origin, onScreen(size), axis.color, 2.5f});
      const Vec3 label = onScreen(size + 11);
      addText(overlay.screenLines, axis.name, {label.x() - 3.2, label.y() - 4.5}, 9, axis.color, 1.6f);
   }
}

void addLegend(Overlay &overlay, const Camera &camera, const Legend &legend, Rgba ink)
{
   const double height = std::min(240.0, 0.6 * camera.height()), width = 18, size = 11;
   const double right = camera.width() - 90, top = 52;
   constexpr int steps = 64;
   for (int i = 0; i < steps; ++i) {
      const double y0 = top + height * i / steps, y1 = top + height * (i + 1) / steps;
      overlay.screenFill.push_back(
          {{Vec3(right, y0, 0), Vec3(right, y1, 0), Vec3(right + width, y1, 0), Vec3(right + width, y0, 0)},
           fieldColor(1 - (i + 0.5) / steps)});
   }
   const std::vector<Vec3> frame{
       {right, top, 0}, {right, top + height, 0}, {right + width, top + height, 0}, {right + width, top, 0}};
   addLoop(overlay.screenLines, frame, ink, 1);
   for (std::size_t i = 0; i < legend.ticks.size(); ++i) {
      const double range = legend.high - legend.low;
      const double y = top + height * (range > 0 ? 1 - (legend.ticks[i] - legend.low) / range : 1);
      overlay.screenLines.push_back({Vec3(right + width, y, 0), Vec3(right + width + 5, y, 0), ink, 1});
      addText(overlay.screenLines, legend.texts[i], {right + width + 9, y - size / 2}, size, ink, 1.3f);
   }
   addText(overlay.screenLines, legend.title, {camera.width() - 16 - textWidth(legend.title, size), top - 26},
           size, ink, 1.3f);
}

} // namespace diatom::render
