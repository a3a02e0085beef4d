// Snap voxel: the frame of an octahedron, twelve struts between six node blocks, one part per cell. The
// coarse mesh has DMDesign's measures; the fine one is our own: it stays within its own cell, so that
// neighbours lie strut to strut, and snaps onto the voxel above with a peg.
#include <diatom/part_shapes.hpp>

#include <cmath>

using namespace diatom::sdk;

namespace {

// Lattice units (edge of the octahedron = 1), in a frame whose axes go through the nodes.
constexpr double kStrut = 0.1; // square section
constexpr double kBlock =
    0.14142135623730951;          // height of a node block: the strut's section cut at 45 degrees
constexpr double kReach = 0.6571; // outer face of the blocks
constexpr double kDrawnScale = 0.706 / kReach; // DMDesign's coarse mesh reaches almost to the corners

/// A square on a node's axis: distance from the centre and half side.
struct Ring
{
   double at, half;
};

// A strut's outer face lies at x + y = reach + kStrut / 2 and may go to the octahedron's edge, sqrt(1/2). Peg
// and socket follow from the voxel above, whose lower block begins at sqrt(2) - reach = 0.7572: the neck
// passes the lip with 0.003 to spare on each side, the barb is 0.002 wider than the lip and rests in the
// wider chamber behind it. The tip is the top of DMDesign's voxel: 4.207 / 2 * 0.706 / 1.9685 + 0.09 =
// 0.8444.
const double kFineReach = std::sqrt(0.5) - kStrut / 2;
const std::vector<Ring> kPeg = {
    {kFineReach, 0.025}, {0.785, 0.025}, {0.790, 0.030}, {0.810, 0.030}, {0.8444, 0.018}};
const std::vector<Ring> kSocket = {{kFineReach, 0.034},
                                   {kFineReach - 0.006, 0.028},
                                   {kFineReach - 0.024, 0.028},
                                   {kFineReach - 0.024, 0.034},
                                   {kFineReach - 0.100, 0.034}};
const std::vector<Ring> kChamfer = {{kFineReach + 0.010, 0.038}};

/// Vertices of the frame, found by place: node 2a is -axis a, node 2a + 1 is +axis a.
class Frame
{
public:
   Frame(PartMesh &mesh, double reach, double scale) : m_mesh(mesh), m_scale(scale)
   {
      for (int node = 0; node < 6; ++node) {
         m_inner[static_cast<std::size_t>(node)] = ring(node, {reach - kBlock, kStrut / 2});
         m_outer[static_cast<std::size_t>(node)] = ring(node, {reach, kStrut / 2});
         cap(m_inner[static_cast<std::size_t>(node)], false);
      }
      for (int a = 0; a < 6; ++a)
         for (int b = a + 1; b < 6; ++b)
            if (a / 2 != b / 2)
               strut(a, b);
   }

   /// Continues a node's block through the rings, inwards or outwards, and closes it at the last one.
   void finish(int node, const std::vector<Ring> &rings)
   {
      Corners last = m_outer[static_cast<std::size_t>(node)];
      for (const Ring &next : rings) {
         const Corners corners = ring(node, next);
         for (std::size_t k = 0; k < 4; ++k)
            m_mesh.quad(last[k], last[(k + 1) % 4], corners[(k + 1) % 4], corners[k]);
         last = corners;
      }
      cap(last, true);
   }

private:
   using Corners = std::array<std::int32_t, 4>;

   /// Four corners, counter-clockwise seen from outside along the node's axis.
   Corners ring(int node, const Ring &at)
   {
      static constexpr int turn[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
      const int axis = node / 2, sign = node % 2 ? 1 : -1;
      Corners corners{};
      for (std::size_t k = 0; k < 4; ++k) {
         Xyz p{};
         p[static_cast<std::size_t>(axis)] = sign * at.at;
         p[static_cast<std::size_t>((axis + 1) % 3)] = sign * turn[k][0] * at.half;
         p[static_cast<std::size_t>((axis + 2) % 3)] = turn[k][1] * at.half;
         corners[k] = put(p);
      }
      return corners;
   }
   /// The lattice's octahedron has its equator corners on the diagonals: an eighth turn about z.
   std::int32_t put(const Xyz &p)
   {
      const double c = std::sqrt(0.5) * m_scale;
      m_axes.push_back(p);
      return m_mesh.vertex(c * (p[0] - p[1]), c * (p[0] + p[1]), m_scale * p[2]);
   }
   void cap(const Corners &c, bool outward)
   {
      outward ? m_mesh.quad(c[0], c[1], c[2], c[3]) : m_mesh.quad(c[3], c[2], c[1], c[0]);
   }
   /// Corner of a ring on the given sides (of -1, 1) of two axes.
   std::int32_t find(const Corners &corners, int axisA, int signA, int axisB, int signB) const
   {
      for (const std::int32_t corner : corners) {
         const Xyz &p = m_axes[static_cast<std::size_t>(corner)];
         if (p[static_cast<std::size_t>(axisA)] * signA > 0 && p[static_cast<std::size_t>(axisB)] * signB > 0)
            return corner;
      }
      throw Failure(DIATOM_INTERNAL, "a strut has no corner");
   }
   /// The strut joins the side of block a that looks along b's axis to the side of b that looks along a's;
   /// both sides are its whole section, so that its four long faces are all that is left to add.
   void strut(int a, int b)
   {
      const int axisA = a / 2, signA = a % 2 ? 1 : -1, axisB = b / 2, signB = b % 2 ? 1 : -1;
      const int across = 3 - axisA - axisB;
      std::array<std::int32_t, 4> atA{},
          atB{}; // round the strut: outer low, outer high, inner high, inner low
      const int sides[4] = {-1, 1, 1, -1};
      for (std::size_t k = 0; k < 4; ++k) {
         const auto &ringA =
             k < 2 ? m_outer[static_cast<std::size_t>(a)] : m_inner[static_cast<std::size_t>(a)];
         const auto &ringB =
             k < 2 ? m_outer[static_cast<std::size_t>(b)] : m_inner[static_cast<std::size_t>(b)];
         atA[k] = find(ringA, axisB, signB, across, sides[k]);
         atB[k] = find(ringB, axisA, signA, across, sides[k]);
      }
      // e_a x e_b is + across for consecutive axes; each mirrored axis turns the sense round.
      const bool forward = ((axisA + 1) % 3 == axisB) == (signA == signB);
      for (std::size_t k = 0; k < 4; ++k) {
         const std::size_t next = (k + 1) % 4;
         forward ? m_mesh.quad(atA[k], atB[k], atB[next], atA[next])
                 : m_mesh.quad(atA[k], atA[next], atB[next], atB[k]);
      }
   }

   PartMesh &m_mesh;
   double m_scale;
   std::vector<Xyz> m_axes; // the vertices before the turn
   std::array<Corners, 6> m_inner{}, m_outer{};
};

PartMesh voxel(const MeshRequest &request)
{
   PartMesh mesh;
   if (request.detail == 0) {
      Frame frame(mesh, kReach, kDrawnScale * request.pitch);
      for (int node = 0; node < 6; ++node)
         frame.finish(node, {});
      return mesh;
   }
   Frame frame(mesh, kFineReach, request.pitch);
   for (int node = 0; node < 4; ++node)
      frame.finish(node, kChamfer);
   frame.finish(4, kSocket);
   frame.finish(5, kPeg);
   return mesh;
}

/// The mesh lies as the octahedra of octahedron_edge do; from there to those of other lattices.
Wxyz turnFor(std::string_view lattice)
{
   const auto about = [](const Xyz &axis, double radians) -> Wxyz {
      const double s = std::sin(radians / 2);
      return {std::cos(radians / 2), s * axis[0], s * axis[1], s * axis[2]};
   };
   if (lattice == "org.diatom_cad.lattice.octahedron_vertex") // corners on the axes
      return about({0, 0, 1}, std::acos(-1.0) / 4);
   if (lattice == "org.diatom_cad.lattice.octahedron_edge_flat") // the peg's corner from +z over to -y
      return about({1, 0, 0}, std::acos(std::sqrt(1.0 / 3)));
   return {1, 0, 0, 0};
}

void oneVoxelPerCell(const Call &call, const diatom_cells &cells, PartList &parts)
{
   partsPerCell(call, cells, parts, {turnFor(latticeOf(cells))});
}

PartSet snapVoxel(const Values &)
{
   PartSet set;
   set.kinds = {{"snap_voxel", "Snap voxel", 1}};
   set.lattices = {"org.diatom_cad.lattice.octahedron_edge", "org.diatom_cad.lattice.octahedron_edge_flat",
                   "org.diatom_cad.lattice.octahedron_vertex"};
   set.details = 2;
   set.mesh = voxel;
   set.decompose = oneVoxelPerCell;
   return set;
}

} // namespace

DIATOM_PARTS(snapVoxel)
