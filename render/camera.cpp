#include "render/camera.h"

#include <algorithm>
#include <cmath>

namespace diatom::render {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kFieldOfView = 35 * kPi / 180; // vertical: little distortion, still depth
constexpr double kZoomPerStep = 0.85;
constexpr double kRadiansPerPixel = 0.008;

} // namespace

std::optional<ViewDirection> viewDirection(std::string_view name)
{
   constexpr std::pair<std::string_view, ViewDirection> names[] = {
       {"iso", ViewDirection::iso},      {"front", ViewDirection::front}, {"back", ViewDirection::back},
       {"left", ViewDirection::left},    {"right", ViewDirection::right}, {"top", ViewDirection::top},
       {"bottom", ViewDirection::bottom}};
   for (const auto &[text, direction] : names)
      if (text == name)
         return direction;
   return std::nullopt;
}

void Camera::resize(double width, double height)
{
   m_width = std::max(1.0, width);
   m_height = std::max(1.0, height);
}

void Camera::look(ViewDirection direction)
{
   switch (direction) {
   case ViewDirection::iso:
      m_yaw = 0.62, m_pitch = 0.52;
      break;
   case ViewDirection::front:
      m_yaw = 0, m_pitch = 0;
      break;
   case ViewDirection::back:
      m_yaw = kPi, m_pitch = 0;
      break;
   case ViewDirection::left:
      m_yaw = -kPi / 2, m_pitch = 0;
      break;
   case ViewDirection::right:
      m_yaw = kPi / 2, m_pitch = 0;
      break;
   case ViewDirection::top:
      m_yaw = 0, m_pitch = kPi / 2;
      break;
   case ViewDirection::bottom:
      m_yaw = 0, m_pitch = -kPi / 2;
      break;
   }
}

void Camera::fit(const Bounds &bounds)
{
   if (bounds.isEmpty())
      return;
   m_target = bounds.center();
   // Narrower of the two half angles, against each corner of the box.
   const double tanY = std::tan(kFieldOfView / 2), tanX = tanY * m_width / m_height;
   double distance = 0;
   for (int i = 0; i < 8; ++i) {
      const Vec3 corner = bounds.corner(static_cast<Bounds::CornerType>(i)) - m_target;
      const double depth = corner.dot(backward());
      distance = std::max({distance, depth + std::abs(corner.dot(right())) / tanX,
                           depth + std::abs(corner.dot(up())) / tanY});
   }
   m_distance = std::max(1.12 * distance, 1e-9);
}

Vec3 Camera::backward() const
{
   return {std::cos(m_pitch) * std::sin(m_yaw), -std::cos(m_pitch) * std::cos(m_yaw), std::sin(m_pitch)};
}

Vec3 Camera::right() const { return {std::cos(m_yaw), std::sin(m_yaw), 0}; }

Vec3 Camera::up() const { return backward().cross(right()); }

void Camera::orbit(double dx, double dy, const Vec3 &pivot)
{
   const auto axes = [this] {
      Mat3 m;
      m << right(), up(), backward();
      return m;
   };
   const Mat3 before = axes();
   const Vec3 arm = m_target - pivot;
   m_yaw = std::remainder(m_yaw - kRadiansPerPixel * dx, 2 * kPi);
   m_pitch = std::clamp(m_pitch + kRadiansPerPixel * dy, -kPi / 2, kPi / 2);
   m_target = pivot + axes() * (before.transpose() * arm);
}

void Camera::pan(double dx, double dy) { m_target += metresPerPixel() * (dy * up() - dx * right()); }

void Camera::zoom(double steps, const Point &at)
{
   const double factor = std::pow(kZoomPerStep, steps);
   const double next = std::clamp(m_distance * factor, 1e-9, 1e6);
   const Vec3 offset = metresPerPixel() * ((at.x() - m_width / 2) * right() - (at.y() - m_height / 2) * up());
   m_target += offset * (1 - next / m_distance);
   m_distance = next;
}

double Camera::metresPerPixel() const { return 2 * m_distance * std::tan(kFieldOfView / 2) / m_height; }

Mat4 Camera::view() const
{
   Mat4 m = Mat4::Identity();
   m.block<1, 3>(0, 0) = right().transpose();
   m.block<1, 3>(1, 0) = up().transpose();
   m.block<1, 3>(2, 0) = backward().transpose();
   m.block<3, 1>(0, 3) = -m.block<3, 3>(0, 0) * eye();
   return m;
}

std::pair<double, double> Camera::clipRange() const
{
   const double radius = m_reach.isEmpty() ? m_distance : m_reach.diagonal().norm() / 2;
   const Vec3 centre = m_reach.isEmpty() ? m_target : Vec3(m_reach.center());
   const double depth = (eye() - centre).dot(backward());
   const double far = std::max(depth + radius, 1e-3 * m_distance) * 1.01;
   if (m_orthographic) // also what is behind the eye
      return {depth - 1.01 * radius, far};
   return {std::max(depth - 1.01 * radius, 2e-3 * std::min(far, m_distance)), far};
}

Mat4 Camera::projection() const
{
   const auto [near, far] = clipRange();
   Mat4 m = Mat4::Zero();
   if (m_orthographic) {
      const double halfY = m_distance * std::tan(kFieldOfView / 2), halfX = halfY * m_width / m_height;
      m(0, 0) = 1 / halfX;
      m(1, 1) = 1 / halfY;
      m(2, 2) = -2 / (far - near);
      m(2, 3) = -(far + near) / (far - near);
      m(3, 3) = 1;
      return m;
   }
   const double scale = 1 / std::tan(kFieldOfView / 2);
   m(0, 0) = scale * m_height / m_width;
   m(1, 1) = scale;
   m(2, 2) = -(far + near) / (far - near);
   m(2, 3) = -2 * far * near / (far - near);
   m(3, 2) = -1;
   return m;
}

Ray Camera::ray(const Point &at) const
{
   const double tanY = std::tan(kFieldOfView / 2);
   const double y = (1 - 2 * at.y() / m_height) * tanY;
   const double x = (2 * at.x() / m_width - 1) * tanY * m_width / m_height;
   if (m_orthographic) {
      const double back = m_distance - clipRange().first;
      return {m_target + m_distance * (x * right() + y * up()) + back * backward(), -backward()};
   }
   return {eye(), (x * right() + y * up() - backward()).normalized()};
}

std::optional<Point> Camera::project(const Vec3 &point) const
{
   const Eigen::Vector4d clip = projection() * (view() * point.homogeneous());
   if (clip.w() <= 0)
      return std::nullopt;
   return Point((clip.x() / clip.w() + 1) * m_width / 2, (1 - clip.y() / clip.w()) * m_height / 2);
}

bool operator==(const Camera &a, const Camera &b)
{
   return a.m_width == b.m_width && a.m_height == b.m_height && a.m_target == b.m_target &&
          a.m_distance == b.m_distance && a.m_yaw == b.m_yaw && a.m_pitch == b.m_pitch &&
          a.m_orthographic == b.m_orthographic && a.m_reach.min() == b.m_reach.min() &&
          a.m_reach.max() == b.m_reach.max();
}

} // namespace diatom::render
