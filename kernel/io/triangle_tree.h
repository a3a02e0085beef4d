// A tree of boxes over the triangles of a mesh: which triangles are near, how often the surface winds around
// a point, which triangle is nearest.
#pragma once

#include "io/triangle_mesh.h"

#include <functional>
#include <span>
#include <vector>

namespace diatom {

/// Keeps a reference to the mesh, which must not change. Any thread.
class TriangleTree
{
public:
   explicit TriangleTree(const TriangleMesh &mesh);

   const TriangleMesh &mesh() const { return m_mesh; }
   std::array<Vec3, 3> corners(std::int32_t triangle) const;

   /// Generalised winding number: 1 inside, 0 outside of a closed surface, between them near holes.
   /// (Jacobson, Kavan, Sorkine-Hornung, Robust inside-outside segmentation, 2013.) Triangles far off count
   /// as one dipole per box (Barill et al., Fast winding numbers for soups and clouds, 2018): the error stays
   /// below 0.05.
   double winding(const Vec3 &point) const;
   /// Calls visit(triangle) for each whose own box meets the box, until it returns false; returns whether it
   /// ran to the end.
   bool visitNear(const Eigen::AlignedBox3d &box,
                  const std::function<bool(std::int32_t triangle)> &visit) const;
   /// The triangle nearest to the point; of several the one with the smallest number.
   std::int32_t nearest(const Vec3 &point) const;

private:
   struct Node
   {
      Eigen::AlignedBox3d box;
      Vec3 dipole = Vec3::Zero();        // sum of area times normal
      Vec3 center = Vec3::Zero();        // of area
      double radius = 0;                 // of the ball about the centre that holds all
      std::int32_t first = 0, count = 0; // into m_order
      bool leaf = true;
      std::size_t end = 0; // past the last node below; the node's own left child, if any, follows it
   };

   void build(std::int32_t first, std::int32_t count);
   void summarise(Node &node) const;
   std::span<const std::int32_t> triangles(const Node &node) const;

   const TriangleMesh &m_mesh;
   std::vector<std::int32_t> m_order;
   std::vector<Node> m_nodes;
};

/// Squared distance of a point from a triangle.
double squaredDistance(const Vec3 &point, const std::array<Vec3, 3> &triangle);

} // namespace diatom
