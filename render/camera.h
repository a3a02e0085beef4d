// The eye: a turntable about a target with Z up, in perspective or orthographic projection. Lengths in
// metres, screen positions in logical pixels from the top left.
#pragma once

#include "core/vec.h"

#include <optional>
#include <string_view>

namespace diatom::render {

using Bounds = Eigen::AlignedBox3d;
using Mat4 = Eigen::Matrix4d;
using Point = Eigen::Vector2d; // on screen

struct Ray
{
   Vec3 origin = Vec3::Zero();
   Vec3 direction = Vec3::UnitX(); // unit length

   Vec3 at(double distance) const { return origin + distance * direction; }
};

enum class ViewDirection { iso, front, back, left, right, top, bottom };

/// The direction of a name ("iso", "front", ...), or nothing.
std::optional<ViewDirection> viewDirection(std::string_view name);

class Camera
{
public:
   void resize(double width, double height);
   double width() const { return m_width; }
   double height() const { return m_height; }

   void look(ViewDirection direction);
   /// Moves back until the bounds fill most of the picture. Directions stay.
   void fit(const Bounds &bounds);
   /// What must stay between the clipping planes.
   void setReach(const Bounds &bounds) { m_reach = bounds; }

   /// Turns about `pivot`: right by dx and down by dy pixels of pointer movement.
   void orbit(double dx, double dy, const Vec3 &pivot);
   /// Moves the picture by (dx, dy) pixels.
   void pan(double dx, double dy);
   /// Zooms in by `steps` wheel notches, keeping what is under the pointer in place.
   void zoom(double steps, const Point &at);

   bool orthographic() const { return m_orthographic; }
   void setOrthographic(bool on) { m_orthographic = on; }

   const Vec3 &target() const { return m_target; }
   double distance() const { return m_distance; }
   Vec3 eye() const { return m_target + m_distance * backward(); }
   Vec3 right() const;
   Vec3 up() const;
   Vec3 backward() const; // from the target to the eye

   Mat4 view() const;
   Mat4 projection() const;
   /// The line of sight through a screen position; starts at the near plane's side of the scene.
   Ray ray(const Point &at) const;
   /// Where a point appears; nothing when it is behind the eye.
   std::optional<Point> project(const Vec3 &point) const;
   /// Metres that one pixel spans at the target.
   double metresPerPixel() const;

   friend bool operator==(const Camera &a, const Camera &b);

private:
   std::pair<double, double> clipRange() const;

   double m_width = 1, m_height = 1;
   Vec3 m_target = Vec3::Zero();
   double m_distance = 0.02;
   double m_yaw = -0.6, m_pitch = 0.5; // rad: of the eye about Z from -Y, and above the horizon
   bool m_orthographic = false;
   Bounds m_reach;
};

} // namespace diatom::render
