// Octahedra joined by corners as wire frames: twelve struts between six node blocks, one part per cell.
// Measures: DMDesign's part; its blocks reach into the next cell's, ours end where that begins.
#include <diatom/part_shapes.hpp>

#include <array>

using namespace diatom::sdk;

namespace {

// Lattice units (edge of the octahedron = 1), from a drawing in which that is 6.9597.
constexpr double kDrawn = 6.9597;
constexpr double kStrut = 0.197 / kDrawn; // side of a square of the strut's section
constexpr double kBlock = 0.91 / kDrawn, kDepth = 0.57 / kDrawn;
constexpr double kBevel =
    0.55 * kDepth; // of the block's inner edges, from which struts start at right angles

Xyz operator+(const Xyz &a, const Xyz &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Xyz operator*(double k, const Xyz &a) { return {k * a[0], k * a[1], k * a[2]}; }
Xyz cross(const Xyz &a, const Xyz &b)
{
   return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

class Wire
{
public:
   Wire(PartMesh &mesh, double pitch, int round) : m_mesh(mesh), m_pitch(pitch), m_round(round) {}

   void make()
   {
      const Xyz axes[6] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
      for (const Xyz &axis : axes)
         node(axis, axes[0][0] * axis[0] != 0 ? axes[1] : axes[0]);
   }

private:
   using Key = std::array<std::int64_t, 3>;

   std::int32_t put(const Xyz &at)
   {
      const auto rounded = [](double v) { return std::llround(v * 1e9); };
      const auto [found, fresh] = m_known.try_emplace(Key{rounded(at[0]), rounded(at[1]), rounded(at[2])}, 0);
      if (fresh)
         found->second = m_mesh.vertex(m_pitch * at[0], m_pitch * at[1], m_pitch * at[2]);
      return found->second;
   }

   /// The block at the end of an axis, its sides looking along v and the three directions after it.
   void node(const Xyz &axis, const Xyz &v)
   {
      const Xyz sides[4] = {v, cross(axis, v), -1.0 * v, -1.0 * cross(axis, v)};
      const double reach = std::sqrt(0.5);
      std::array<std::array<std::int32_t, 4>, 3> rings{}; // from the tip inwards
      const double at[3] = {reach, reach - kDepth + kBevel, reach - kDepth};
      const double half[3] = {kBlock / 2, kBlock / 2, kBlock / 2 - kBevel};
      for (std::size_t ring = 0; ring < 3; ++ring)
         for (std::size_t k = 0; k < 4; ++k)
            rings[ring][k] = put(at[ring] * axis + half[ring] * (sides[k] + sides[(k + 1) % 4]));
      m_mesh.quad(rings[0][0], rings[0][1], rings[0][2], rings[0][3]);
      m_mesh.quad(rings[2][3], rings[2][2], rings[2][1], rings[2][0]);
      for (std::size_t k = 0; k < 4; ++k) {
         const std::size_t before = (k + 3) % 4;
         m_mesh.quad(rings[1][before], rings[1][k], rings[0][k], rings[0][before]);
         bevel({rings[1][k], rings[1][before], rings[2][before], rings[2][k]}, axis, sides[k]);
      }
   }

   /// Where a strut leaves the block at the end of `from` for the one at the end of `to`: points round its
   /// section.
   std::vector<std::int32_t> section(const Xyz &from, const Xyz &to)
   {
      const double reach = std::sqrt(0.5);
      const Xyz middle = (reach - kDepth + kBevel / 2) * from + (kBlock / 2 - kBevel / 2) * to;
      const Xyz across = cross(from, to), outward = std::sqrt(0.5) * (from + to);
      // As large as the square strut, whatever the number of sides.
      const double step = 2 * std::acos(-1.0) / m_round;
      const double radius = kStrut / std::sqrt(m_round / 2.0 * std::sin(step));
      std::vector<std::int32_t> points;
      for (int k = 0; k < m_round; ++k)
         points.push_back(
             put(middle + radius * std::cos(k * step) * across + radius * std::sin(k * step) * outward));
      return points;
   }

   /// The bevel around a strut, and half of the struts: those that start at the first of their two ends.
   void bevel(const std::array<std::int32_t, 4> &corners, const Xyz &axis, const Xyz &side)
   {
      const auto round = section(axis, side);
      const std::size_t count = round.size(), quarter = count / 4;
      for (std::size_t k = 0; k < 4; ++k) {
         m_mesh.triangle(corners[(k + 3) % 4], corners[k], round[k * quarter]);
         for (std::size_t n = k * quarter; n < (k + 1) * quarter; ++n)
            m_mesh.triangle(corners[k], round[(n + 1) % count], round[n]);
      }
      if (axis < side)
         return;
      // Seen from the other end the section goes round the other way, from the opposite side on.
      const auto far = section(side, axis);
      const auto mirrored = [&](std::size_t n) { return far[(count + count / 2 - n % count) % count]; };
      for (std::size_t n = 0; n < count; ++n)
         m_mesh.quad(round[n], round[(n + 1) % count], mirrored(n + 1), mirrored(n));
   }

   PartMesh &m_mesh;
   double m_pitch;
   int m_round;
   std::map<Key, std::int32_t> m_known;
};

PartMesh wire(const MeshRequest &request)
{
   PartMesh mesh;
   Wire(mesh, request.pitch, request.detail == 0 ? 4 : 16).make();
   return mesh;
}

PartSet octahedronKenny(const Values &)
{
   PartSet set;
   set.kinds = {{"wire", "Wire octahedron", 1}};
   set.lattices = {"org.diatom_cad.lattice.octahedron_vertex"};
   set.details = 2;
   set.mesh = wire;
   return set;
}

} // namespace

DIATOM_PARTS(octahedronKenny)
