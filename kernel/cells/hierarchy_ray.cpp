// Rays: down the hierarchy and its trees by boxes in index space, cell by cell in bricks, then exact against
// the shapes.
#include "cells/hierarchy_summary.h"
#include "cells/tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace diatom {

using namespace detail;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Span
{
   double enter = -kInfinity, exit = kInfinity;

   void clip(const Span &other)
   {
      enter = std::max(enter, other.enter);
      exit = std::min(exit, other.exit);
   }
};

/// A ray in the frame of one composite, in metres and in index space; the parameter is metres in both.
struct Ray
{
   Ray(const Vec3 &from, const Vec3 &along, const Placing &placing)
       : origin(from), direction(along), indexOrigin(placing.inverse() * from),
         indexDirection(placing.inverse() * along), reciprocal(indexDirection.cwiseInverse())
   {}

   /// Where the ray is between two index coordinates of an axis.
   Span slab(int axis, double low, double high) const
   {
      if (indexDirection[axis] == 0) {
         const bool inside = indexOrigin[axis] >= low && indexOrigin[axis] <= high;
         return inside ? Span() : Span{kInfinity, -kInfinity};
      }
      const double a = (low - indexOrigin[axis]) * reciprocal[axis];
      const double b = (high - indexOrigin[axis]) * reciprocal[axis];
      return {std::min(a, b), std::max(a, b)};
   }
   Span box(const Vec3 &low, const Vec3 &high) const
   {
      Span span = slab(0, low[0], high[0]);
      span.clip(slab(1, low[1], high[1]));
      span.clip(slab(2, low[2], high[2]));
      return span;
   }

   Vec3 origin, direction, indexOrigin, indexDirection, reciprocal;
};

struct Crossing
{
   Span span;
   int face = 0; // entered through
};

/// The ray against a convex cell.
Crossing cross(const Ray &ray, const Vec3 &centre, const std::vector<Plane> &planes)
{
   Crossing crossing;
   const Vec3 from = ray.origin - centre;
   for (std::size_t f = 0; f < planes.size(); ++f) {
      const double gap = planes[f].distance - planes[f].normal.dot(from);
      const double speed = planes[f].normal.dot(ray.direction);
      if (speed < 0 && gap / speed > crossing.span.enter) {
         crossing.span.enter = gap / speed;
         crossing.face = static_cast<int>(f);
      } else if (speed > 0) {
         crossing.span.exit = std::min(crossing.span.exit, gap / speed);
      } else if (speed == 0 && gap < 0) {
         crossing.span = {kInfinity, -kInfinity};
         return crossing;
      }
   }
   return crossing;
}

} // namespace

/// One ray through one hierarchy: keeps the nearest cell found so far.
class Hierarchy::Caster
{
public:
   Caster(const Placing &placing, double reach) : m_placing(placing), m_nearest(reach)
   {
      for (const Index d : placing.reach())
         m_reach.extend(d);
   }

   void cast(const Summary &summary, const Ray &ray)
   {
      if (!meets(ray, summary.bounds))
         return;
      m_improved = false;
      if (const RootView root = viewRoot(summary.body.cells.root()); root.node)
         castBlock(summary.body.cells.root(), root.origin, root.node->level, ray);
      if (m_improved)
         m_bestPath = m_path;
      castInstances(summary, ray);
   }
   bool hit() const { return m_any; }
   Index local() const { return m_local; }
   double distance() const { return m_nearest; }
   const std::vector<Placement> &path() const { return m_bestPath; }

private:
   struct Candidate
   {
      double enter = 0;
      std::size_t chunk = 0, number = 0;
   };
   struct Child
   {
      double enter = 0;
      unsigned number = 0;
   };

   Span spanOf(const Ray &ray, const Box &box) const
   {
      return ray.box(vec(box.min) + m_placing.low(), vec(box.max) + m_placing.high());
   }
   bool within(const Span &span) const
   {
      return span.enter <= span.exit && span.exit >= 0 && span.enter < m_nearest;
   }
   bool meets(const Ray &ray, const Box &box) const { return !box.empty() && within(spanOf(ray, box)); }

   void castInstances(const Summary &summary, const Ray &ray)
   {
      std::vector<Candidate> candidates;
      const auto chunks = summary.body.instances.chunks();
      summary.chunkBoxes.visit([&](const Box &box) { return meets(ray, box); },
                               [&](std::size_t c) {
                                  for (std::size_t n = 0; n < chunks[c]->size(); ++n) {
                                     const std::uint32_t kind = summary.kindOf[c][n];
                                     if (kind == Summary::kSkipped)
                                        continue;
                                     const Index origin = (*chunks[c])[n].origin;
                                     const Span span = spanOf(ray, summary.kinds[kind].boxAt(origin));
                                     if (within(span))
                                        candidates.push_back({span.enter, c, n});
                                  }
                                  return true;
                               });
      // Nearest first; equal ones in the instances' own order.
      std::stable_sort(candidates.begin(), candidates.end(),
                       [](const Candidate &a, const Candidate &b) { return a.enter < b.enter; });
      const Lattice &lattice = m_placing.lattice();
      const Vec3 zero = lattice.position({});
      for (const Candidate &candidate : candidates) {
         if (candidate.enter >= m_nearest)
            return;
         const Placement &p = (*chunks[candidate.chunk])[candidate.number];
         const Quat back = lattice.rotations()[p.rotation].conjugate();
         const Ray inner(zero + back * (ray.origin - lattice.position(p.origin)), back * ray.direction,
                         m_placing);
         m_path.push_back(p);
         cast(*summary.kinds[summary.kindOf[candidate.chunk][candidate.number]].summary, inner);
         m_path.pop_back();
      }
   }

   void castBlock(const Block &block, Coord origin, int level, const Ray &ray)
   {
      if (!block.isNode()) {
         march(ray, blockBox(origin, level), [](Index) { return true; });
      } else if (level == 0) {
         const Brick &brick = asBrick(*block.node());
         march(ray, brick.bounds, [&](Index i) { return brick.at(brickCell(biased(i))) != 0; });
      } else {
         castChildren(asInner(*block.node()), origin, ray);
      }
   }

   void castChildren(const Inner &inner, Coord origin, const Ray &ray)
   {
      // The 64 children share four slabs per axis.
      std::array<std::array<Span, 4>, 3> slabs;
      const Vec3 corner = Vec3(origin.x, origin.y, origin.z) - Vec3::Constant(kBias);
      const double side = sideMask(inner.level - 1) + 1.0;
      for (int a = 0; a < 3; ++a)
         for (int k = 0; k < 4; ++k)
            slabs[static_cast<std::size_t>(a)][static_cast<std::size_t>(k)] =
                ray.slab(a, corner[a] + k * side + m_placing.low()[a],
                         corner[a] + (k + 1) * side - 1 + m_placing.high()[a]);
      std::array<Child, 64> children;
      std::size_t count = 0;
      for (unsigned c = 0; c < 64; ++c) {
         Span span = slabs[0][c >> 4];
         span.clip(slabs[1][c >> 2 & 3]);
         span.clip(slabs[2][c & 3]);
         if (inner.children[c].empty() || !within(span))
            continue;
         std::size_t at = count++;
         for (; at > 0 && children[at - 1].enter > span.enter; --at)
            children[at] = children[at - 1];
         children[at] = {span.enter, c};
      }
      for (std::size_t k = 0; k < count && children[k].enter < m_nearest; ++k) {
         const unsigned c = children[k].number;
         const Block &child = inner.children[c];
         if (!child.isNode() || meets(ray, child.node()->bounds))
            castBlock(child, childOrigin(origin, inner.level, c), inner.level - 1, ray);
      }
   }

   /// From unit box to unit box of index space along the ray (Amanatides and Woo, "A fast voxel traversal
   /// algorithm for ray tracing", Eurographics 1987); in each, every cell that may reach into it.
   template<typename Occupied>
   void march(const Ray &ray, const Box &box, const Occupied &occupied)
   {
      const Index from = box.min - m_reach.max, to = box.max - m_reach.min;
      const Span span = ray.box(vec(from) - Vec3::Constant(0.5), vec(to) + Vec3::Constant(0.5));
      if (!within(span))
         return;
      const double start = std::max(span.enter, 0.0);
      const std::int32_t low[3] = {from.x, from.y, from.z}, high[3] = {to.x, to.y, to.z};
      std::int32_t at[3];
      double next[3];
      for (int a = 0; a < 3; ++a) {
         const double q = ray.indexOrigin[a] + start * ray.indexDirection[a];
         at[a] = static_cast<std::int32_t>(std::clamp(std::floor(q + 0.5), double(low[a]), double(high[a])));
         next[a] = boundary(ray, a, at[a]);
      }
      for (;;) {
         const int axis = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
         for (const Index d : m_placing.reach()) {
            const Index i = Index{at[0], at[1], at[2]} + d;
            if (box.contains(i) && occupied(i))
               tryCell(ray, i);
         }
         // Cells beyond are met later than this unit box is left.
         if (m_nearest <= next[axis] || next[axis] > span.exit)
            return;
         at[axis] += ray.indexDirection[axis] > 0 ? 1 : -1;
         if (at[axis] < low[axis] || at[axis] > high[axis])
            return;
         next[axis] = boundary(ray, axis, at[axis]);
      }
   }
   static double boundary(const Ray &ray, int axis, std::int32_t at)
   {
      const double d = ray.indexDirection[axis];
      return d == 0 ? kInfinity : (at + (d > 0 ? 0.5 : -0.5) - ray.indexOrigin[axis]) * ray.reciprocal[axis];
   }
   void tryCell(const Ray &ray, Index i)
   {
      const Lattice &lattice = m_placing.lattice();
      const Crossing crossing = cross(ray, lattice.position(i), m_placing.planes(lattice.site(i)));
      if (!within(crossing.span))
         return;
      m_nearest = std::max(crossing.span.enter, 0.0);
      m_local = i;
      m_any = m_improved = true;
   }

   const Placing &m_placing;
   Box m_reach; // box of Placing::reach()
   double m_nearest;
   Index m_local;
   bool m_any = false, m_improved = false;
   std::vector<Placement> m_path, m_bestPath;
};

std::optional<RayHit> Hierarchy::hit(const Vec3 &origin, const Vec3 &direction, double reach) const
{
   const double length = direction.norm();
   if (!origin.allFinite() || !std::isfinite(length) || length == 0 || std::isnan(reach))
      return std::nullopt;
   const Ray ray(origin, direction / length, *m_placing);
   Caster caster(*m_placing, reach);
   caster.cast(*m_root, ray);
   if (!caster.hit())
      return std::nullopt;
   RayHit hit;
   hit.found = found(caster.path(), caster.local());
   hit.distance = caster.distance();
   hit.point = ray.origin + hit.distance * ray.direction;
   const Index at = hit.found.index;
   hit.face = cross(ray, m_lattice->position(at), m_placing->planes(m_lattice->site(at))).face;
   return hit;
}

} // namespace diatom
