#include "assembly/columns.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace diatom {

namespace {

using Vec2 = Eigen::Vector2d;

/// A cell seen from above: convex, counter-clockwise.
struct Outline
{
   std::vector<Vec2> corners;
   double radius = 0;
};

double cross(const Vec2 &o, const Vec2 &a, const Vec2 &b)
{
   return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

/// Andrew's monotone chain.
Outline outlineOf(std::span<const Vec3> corners, double tolerance)
{
   std::vector<Vec2> points;
   for (const Vec3 &corner : corners)
      points.push_back(corner.head<2>());
   std::sort(points.begin(), points.end(),
             [](const Vec2 &a, const Vec2 &b) { return std::tie(a.x(), a.y()) < std::tie(b.x(), b.y()); });
   Outline outline;
   for (int side = 0; side < 2; ++side) {
      const std::size_t base = outline.corners.size();
      for (const Vec2 &p : points) {
         auto &hull = outline.corners;
         while (hull.size() >= base + 2 &&
                cross(hull[hull.size() - 2], hull.back(), p) <= tolerance * tolerance)
            hull.pop_back();
         hull.push_back(p);
      }
      outline.corners.pop_back(); // first point of the other side
      std::reverse(points.begin(), points.end());
   }
   for (const Vec2 &corner : outline.corners)
      outline.radius = std::max(outline.radius, corner.norm());
   return outline;
}

bool same(const Outline &a, const Outline &b, double tolerance)
{
   if (a.corners.size() != b.corners.size())
      return false;
   for (std::size_t i = 0; i < a.corners.size(); ++i)
      if ((a.corners[i] - b.corners[i]).norm() > tolerance)
         return false;
   return true;
}

/// Whether an edge normal of `a` separates it from `b`, which stands at `at`; less than `slack` of overlap is
/// none.
bool separates(const Outline &a, const Outline &b, const Vec2 &at, double slack)
{
   for (std::size_t i = 0; i < a.corners.size(); ++i) {
      const Vec2 edge = a.corners[(i + 1) % a.corners.size()] - a.corners[i];
      const Vec2 outward = Vec2(edge.y(), -edge.x()).normalized();
      double nearest = outward.dot(b.corners.front() + at);
      for (const Vec2 &corner : b.corners)
         nearest = std::min(nearest, outward.dot(corner + at));
      if (nearest > outward.dot(a.corners[i]) - slack)
         return true;
   }
   return false;
}

/// Separating axes of two convex polygons.
bool overlap(const Outline &a, const Outline &b, const Vec2 &at, double slack)
{
   return at.norm() < a.radius + b.radius - slack && !separates(a, b, at, slack) &&
          !separates(b, a, -at, slack);
}

struct Column
{
   std::int64_t x, y; // place, in steps of the tolerance
   int outline;
   auto key() const { return std::tie(x, y, outline); }
};

/// Outlines that differ, and the one of every site.
struct Outlines
{
   std::vector<Outline> distinct;
   std::vector<int> ofSite;
   double radius = 0;

   Outlines(const Lattice &lattice, double tolerance)
   {
      for (int site = 0; site < lattice.sites(); ++site) {
         Outline outline = outlineOf(lattice.corners(site), tolerance);
         const auto known = std::find_if(distinct.begin(), distinct.end(),
                                         [&](const Outline &o) { return same(o, outline, tolerance); });
         ofSite.push_back(static_cast<int>(known - distinct.begin()));
         radius = std::max(radius, outline.radius);
         if (known == distinct.end())
            distinct.push_back(std::move(outline));
      }
   }
};

using Pair = std::pair<std::int32_t, std::int32_t>;

/// All overlapping pairs, found through square bins as wide as the widest outline.
std::vector<Pair> overlappingPairs(const std::vector<Column> &columns, const Outlines &outlines,
                                   double tolerance)
{
   const double width = 2 * outlines.radius / tolerance; // in steps
   struct Binned
   {
      std::int64_t x, y;
      std::int32_t column;
      auto key() const { return std::tie(x, y); }
   };
   std::vector<Binned> bins;
   bins.reserve(columns.size());
   for (std::size_t c = 0; c < columns.size(); ++c)
      bins.push_back({static_cast<std::int64_t>(std::floor(static_cast<double>(columns[c].x) / width)),
                      static_cast<std::int64_t>(std::floor(static_cast<double>(columns[c].y) / width)),
                      static_cast<std::int32_t>(c)});
   std::sort(bins.begin(), bins.end(), [](const Binned &a, const Binned &b) {
      return std::tie(a.x, a.y, a.column) < std::tie(b.x, b.y, b.column);
   });

   std::vector<Pair> pairs;
   const auto before = [](const Binned &a, const Binned &b) { return a.key() < b.key(); };
   for (const Binned &bin : bins) {
      const Column &a = columns[static_cast<std::size_t>(bin.column)];
      const Outline &outlineA = outlines.distinct[static_cast<std::size_t>(a.outline)];
      for (std::int64_t dx = -1; dx <= 1; ++dx) {
         const auto from =
             std::lower_bound(bins.begin(), bins.end(), Binned{bin.x + dx, bin.y - 1, 0}, before);
         const auto to = std::upper_bound(from, bins.end(), Binned{bin.x + dx, bin.y + 1, 0}, before);
         for (auto other = from; other != to; ++other) {
            const Column &b = columns[static_cast<std::size_t>(other->column)];
            const Vec2 at(static_cast<double>(b.x - a.x) * tolerance,
                          static_cast<double>(b.y - a.y) * tolerance);
            if (other->column == bin.column ||
                overlap(outlineA, outlines.distinct[static_cast<std::size_t>(b.outline)], at, 8 * tolerance))
               pairs.emplace_back(bin.column, other->column);
         }
      }
   }
   std::sort(pairs.begin(), pairs.end());
   return pairs;
}

} // namespace

Columns::Columns(const Lattice &lattice, std::span<const Index> cells)
{
   // Places are told apart to a thousandth of a cell; two columns that rounding split still overlap each
   // other.
   const double tolerance = 1e-3 * lattice.radius();
   const Outlines outlines(lattice, tolerance);
   std::vector<Column> ofCell;
   ofCell.reserve(cells.size());
   for (const Index cell : cells) {
      const Vec3 p = lattice.position(cell);
      ofCell.push_back({std::llround(p.x() / tolerance), std::llround(p.y() / tolerance),
                        outlines.ofSite[static_cast<std::size_t>(lattice.site(cell))]});
   }
   std::vector<Column> columns = ofCell;
   const auto before = [](const Column &a, const Column &b) { return a.key() < b.key(); };
   std::sort(columns.begin(), columns.end(), before);
   columns.erase(std::unique(columns.begin(), columns.end(),
                             [](const Column &a, const Column &b) { return a.key() == b.key(); }),
                 columns.end());
   m_columnOf.reserve(cells.size());
   for (const Column &column : ofCell)
      m_columnOf.push_back(static_cast<std::int32_t>(
          std::lower_bound(columns.begin(), columns.end(), column, before) - columns.begin()));

   const std::vector<Pair> pairs = overlappingPairs(columns, outlines, tolerance);
   m_start.assign(columns.size() + 1, 0);
   for (const auto &[column, other] : pairs) {
      ++m_start[static_cast<std::size_t>(column) + 1];
      m_overlaps.push_back(other);
   }
   std::partial_sum(m_start.begin(), m_start.end(), m_start.begin());
}

} // namespace diatom
