#include "io/cell_solid.h"

namespace diatom {

namespace {

constexpr std::size_t kSamples = 64;
/// Of the cell's radius: contacts thinner than this are none.
constexpr double kSkin = 1e-6;

/// Number k of Halton's sequence: evenly spread, always the same.
double halton(int k, int base)
{
   double value = 0, part = 1;
   for (; k > 0; k /= base) {
      part /= base;
      value += part * (k % base);
   }
   return value;
}

} // namespace

CellSolid::CellSolid(const Lattice &lattice, int site)
{
   const auto corners = lattice.corners(site);
   Eigen::AlignedBox3d box;
   for (const Vec3 &corner : corners)
      box.extend(corner);
   for (const auto &face : lattice.shape(site).faces) {
      const auto at = [&](std::size_t k) { return corners[static_cast<std::size_t>(face[k])]; };
      const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(1)).normalized();
      m_planes.push_back({normal, normal.dot(at(0)) - kSkin * lattice.radius()});
   }
   for (int k = 1; m_samples.size() < kSamples; ++k) {
      const Vec3 unit(halton(k, 2), halton(k, 3), halton(k, 5));
      const Vec3 point = box.min() + unit.cwiseProduct(box.sizes());
      if (inside(point))
         m_samples.push_back(point);
   }
}

bool CellSolid::inside(const Vec3 &point) const
{
   for (const Plane &plane : m_planes)
      if (plane.normal.dot(point) >= plane.offset)
         return false;
   return true;
}

bool CellSolid::entered(const std::array<Vec3, 3> &triangle) const
{
   // What is left of the triangle when cut by each plane in turn (Sutherland and Hodgman, 1974).
   std::vector<Vec3> polygon(triangle.begin(), triangle.end()), cut;
   for (const Plane &plane : m_planes) {
      cut.clear();
      for (std::size_t k = 0; k < polygon.size(); ++k) {
         const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
         const double da = plane.normal.dot(a) - plane.offset, db = plane.normal.dot(b) - plane.offset;
         if (da < 0)
            cut.push_back(a);
         if ((da < 0) != (db < 0))
            cut.push_back(a + da / (da - db) * (b - a));
      }
      if (cut.empty())
         return false;
      polygon.swap(cut);
   }
   return true;
}

} // namespace diatom
