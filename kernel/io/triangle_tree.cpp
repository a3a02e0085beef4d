#include "io/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace diatom {

namespace {

constexpr std::int32_t kLeafTriangles = 8;
/// A box counts as one dipole from this many of its radii on.
constexpr double kFar = 2;

/// Of the oriented triangle, seen from the point: Van Oosterom and Strackee, The solid angle of a plane
/// triangle, 1983.
double solidAngle(const Vec3 &point, const std::array<Vec3, 3> &triangle)
{
   const Vec3 a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
   const double la = a.norm(), lb = b.norm(), lc = c.norm();
   return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

} // namespace

TriangleTree::TriangleTree(const TriangleMesh &mesh) : m_mesh(mesh)
{
   m_order.resize(mesh.triangles.size());
   for (std::size_t k = 0; k < m_order.size(); ++k)
      m_order[k] = static_cast<std::int32_t>(k);
   m_nodes.reserve(m_order.size() / 2);
   if (!m_order.empty())
      build(0, static_cast<std::int32_t>(m_order.size()));
}

std::array<Vec3, 3> TriangleTree::corners(std::int32_t triangle) const
{
   const auto &numbers = m_mesh.triangles[static_cast<std::size_t>(triangle)];
   const auto at = [&](std::size_t k) { return m_mesh.vertices[static_cast<std::size_t>(numbers[k])]; };
   return {at(0), at(1), at(2)};
}

std::span<const std::int32_t> TriangleTree::triangles(const Node &node) const
{
   return {m_order.data() + node.first, static_cast<std::size_t>(node.count)};
}

void TriangleTree::build(std::int32_t first, std::int32_t count)
{
   const std::size_t number = m_nodes.size();
   Node node;
   node.first = first;
   node.count = count;
   node.leaf = count <= kLeafTriangles;
   summarise(node);
   m_nodes.push_back(node);
   if (!node.leaf) {
      // In half, across the longest side of the middles: the depth stays below 32 whatever the mesh.
      Eigen::AlignedBox3d middles;
      const auto middle = [this](std::int32_t triangle) {
         const auto p = corners(triangle);
         return Vec3(p[0] + p[1] + p[2]);
      };
      const auto from = m_order.begin() + first;
      std::for_each(from, from + count, [&](std::int32_t triangle) { middles.extend(middle(triangle)); });
      Eigen::Index axis = 0;
      middles.sizes().maxCoeff(&axis);
      std::nth_element(from, from + count / 2, from + count, [&](std::int32_t a, std::int32_t b) {
         const double at = middle(a)[axis], other = middle(b)[axis];
         return at != other ? at < other : a < b;
      });
      build(first, count / 2);
      build(first + count / 2, count - count / 2);
   }
   m_nodes[number].end = m_nodes.size();
}

void TriangleTree::summarise(Node &node) const
{
   double area = 0;
   for (const std::int32_t triangle : triangles(node)) {
      const auto p = corners(triangle);
      for (const Vec3 &corner : p)
         node.box.extend(corner);
      const Vec3 twice = (p[1] - p[0]).cross(p[2] - p[0]);
      node.dipole += twice / 2;
      node.center += twice.norm() * (p[0] + p[1] + p[2]) / 3;
      area += twice.norm();
   }
   node.center = area > 0 ? Vec3(node.center / area) : node.box.center();
   for (const std::int32_t triangle : triangles(node))
      for (const Vec3 &corner : corners(triangle))
         node.radius = std::max(node.radius, (corner - node.center).norm());
}

double TriangleTree::winding(const Vec3 &point) const
{
   double sum = 0;
   for (std::size_t k = 0; k < m_nodes.size();) {
      const Node &node = m_nodes[k];
      const Vec3 from = node.center - point;
      const double square = from.squaredNorm();
      const bool far = square > kFar * kFar * node.radius * node.radius;
      if (far)
         sum += node.dipole.dot(from) / (square * std::sqrt(square));
      else if (node.leaf)
         for (const std::int32_t triangle : triangles(node))
            sum += solidAngle(point, corners(triangle));
      k = far ? node.end : k + 1;
   }
   return sum / (4 * std::numbers::pi);
}

bool TriangleTree::visitNear(const Eigen::AlignedBox3d &box,
                             const std::function<bool(std::int32_t triangle)> &visit) const
{
   for (std::size_t k = 0; k < m_nodes.size();) {
      const Node &node = m_nodes[k];
      const bool meets = node.box.intersects(box);
      if (meets && node.leaf)
         for (const std::int32_t triangle : triangles(node)) {
            const auto p = corners(triangle);
            if (Eigen::AlignedBox3d(p[0].cwiseMin(p[1]).cwiseMin(p[2]), p[0].cwiseMax(p[1]).cwiseMax(p[2]))
                    .intersects(box) &&
                !visit(triangle))
               return false;
         }
      k = meets ? k + 1 : node.end;
   }
   return true;
}

std::int32_t TriangleTree::nearest(const Vec3 &point) const
{
   std::int32_t best = -1;
   double least = std::numeric_limits<double>::infinity();
   const auto look = [&](auto &&self, std::size_t k) -> void {
      const Node &node = m_nodes[k];
      if (node.box.squaredExteriorDistance(point) > least)
         return;
      if (!node.leaf) {
         const std::size_t left = k + 1, right = m_nodes[left].end;
         const bool leftFirst = m_nodes[left].box.squaredExteriorDistance(point) <=
                                m_nodes[right].box.squaredExteriorDistance(point);
         self(self, leftFirst ? left : right);
         self(self, leftFirst ? right : left);
         return;
      }
      for (const std::int32_t triangle : triangles(node)) {
         const double distance = squaredDistance(point, corners(triangle));
         if (distance < least || (distance == least && triangle < best)) {
            least = distance;
            best = triangle;
         }
      }
   };
   if (!m_nodes.empty())
      look(look, 0);
   return best;
}

double squaredDistance(const Vec3 &point, const std::array<Vec3, 3> &triangle)
{
   const auto toEdge = [&](const Vec3 &a, const Vec3 &b) {
      const Vec3 along = b - a;
      const double length = along.squaredNorm();
      const double t = length > 0 ? std::clamp((point - a).dot(along) / length, 0.0, 1.0) : 0;
      return (a + t * along - point).squaredNorm();
   };
   const Vec3 &a = triangle[0], &b = triangle[1], &c = triangle[2];
   const Vec3 normal = (b - a).cross(c - a);
   const double square = normal.squaredNorm();
   const auto within = [&](const Vec3 &from, const Vec3 &to) {
      return normal.dot((to - from).cross(point - from)) >= 0;
   };
   if (square > 0 && within(a, b) && within(b, c) && within(c, a)) {
      const double height = normal.dot(point - a);
      return height * height / square;
   }
   return std::min({toEdge(a, b), toEdge(b, c), toEdge(c, a)});
}

} // namespace diatom
