#include "io/strut_limit.h"

#include "io/node_hull.h"
#include "io/place_grid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_set>

namespace diatom {

namespace {

/// Of a strut, what must be left between the joints at its ends.
constexpr double kLeftOver = 0.02;

/// Closest distance of two segments, each from a point along a vector (Ericson, Real-Time Collision
/// Detection, 5.1.9); vectors may be zero.
double segmentDistance(const Vec3 &p, const Vec3 &u, const Vec3 &q, const Vec3 &v)
{
   const Vec3 w = p - q;
   const double a = u.squaredNorm(), e = v.squaredNorm(), f = v.dot(w), c = u.dot(w), b = u.dot(v);
   const double denominator = a * e - b * b;
   double s = denominator > 1e-12 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
   double t = e > 0 ? (b * s + f) / e : 0.0;
   if (t < 0 || t > 1 || e == 0) {
      t = std::clamp(t, 0.0, 1.0);
      s = a > 0 ? std::clamp((b * t - c) / a, 0.0, 1.0) : 0.0;
   }
   return (w + u * s - v * t).norm();
}

/// A strut, or a joint as a ball: a segment with a radius in units of the struts' radius.
struct Item
{
   Vec3 from, along;
   double thick;
   std::uint32_t a, b; // nodes
};

class Crowding
{
public:
   Crowding(const StrutGraph &graph, const std::vector<double> &setBacks)
   {
      double longest = 0;
      for (const Strut &strut : graph.struts) {
         longest = std::max(longest, graph.length(strut));
         m_connected.insert(key(strut.a, strut.b));
         m_items.push_back(
             {graph.nodes[strut.a], graph.nodes[strut.b] - graph.nodes[strut.a], 1, strut.a, strut.b});
      }
      for (std::uint32_t n = 0; n < graph.nodes.size(); ++n)
         m_items.push_back({graph.nodes[n], Vec3::Zero(), std::hypot(setBacks[n], 1.0), n, n});
      m_grid = PlaceGrid(2 * longest);
      for (std::uint32_t i = 0; i < m_items.size(); ++i)
         m_grid.add(middle(m_items[i]), i);
   }

   std::size_t items() const { return m_items.size(); }

   /// Lowers the limit by what is near the item and shares no node with it.
   void lower(std::uint32_t i, StrutLimit &limit) const
   {
      const Item &item = m_items[i];
      m_grid.near(middle(item), [&](std::uint32_t j) {
         const Item &other = m_items[j];
         if (j >= i || item.a == other.a || item.a == other.b || item.b == other.a || item.b == other.b ||
             (item.a == item.b && other.a == other.b && m_connected.count(key(item.a, other.a))))
            return;
         const double thick = item.thick + other.thick;
         const double apart = (middle(item) - middle(other)).norm();
         if (apart - (item.along.norm() + other.along.norm()) / 2 > thick * limit.radius)
            return;
         const double most = segmentDistance(item.from, item.along, other.from, other.along) / thick;
         if (most < limit.radius)
            limit = {most, middle(item), true};
      });
   }

private:
   static Vec3 middle(const Item &item) { return item.from + item.along / 2; }
   static std::uint64_t key(std::uint32_t a, std::uint32_t b)
   {
      return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
   }
   std::vector<Item> m_items;
   std::unordered_set<std::uint64_t> m_connected;
   PlaceGrid m_grid{1};
};

} // namespace

std::vector<double> setBacks(const StrutGraph &graph)
{
   std::vector<double> all;
   std::map<std::vector<int>, double> known; // by the directions of the struts that leave
   std::vector<Vec3> leaving;
   std::vector<int> kind;
   for (std::uint32_t n = 0; n < graph.nodes.size(); ++n) {
      leaving.clear();
      kind.clear();
      for (const std::uint32_t s : graph.at[n]) {
         const Strut &strut = graph.struts[s];
         leaving.push_back(graph.leaving(strut, n));
         kind.push_back(2 * strut.axis + ((strut.a == n) != strut.reversed ? 0 : 1));
      }
      std::sort(kind.begin(), kind.end());
      const auto [found, added] = known.emplace(kind, 0.0);
      if (added)
         found->second = leaving.size() < 2 ? 0.0 : setBack(leaving);
      all.push_back(found->second);
   }
   return all;
}

Result<StrutLimit> strutLimit(const StrutGraph &graph, const std::vector<double> &setBacks, const Job &job)
{
   StrutLimit limit{1e300, Vec3::Zero(), false};
   for (const Strut &strut : graph.struts) {
      const double room = (1 - kLeftOver) * graph.length(strut);
      const double most = room / std::max(setBacks[strut.a] + setBacks[strut.b], 1.0);
      if (most < limit.radius)
         limit = {most, (graph.nodes[strut.a] + graph.nodes[strut.b]) / 2, false};
   }
   const Crowding crowding(graph, setBacks);
   constexpr std::int64_t kGrain = 4096;
   const auto count = static_cast<std::int64_t>(crowding.items());
   std::vector<StrutLimit> pieces(static_cast<std::size_t>((count + kGrain - 1) / kGrain), limit);
   job.parallelFor(count, kGrain, [&](std::int64_t begin, std::int64_t end) {
      StrutLimit &own = pieces[static_cast<std::size_t>(begin / kGrain)];
      for (std::int64_t i = begin; i < end && !job.cancelled(); ++i)
         crowding.lower(static_cast<std::uint32_t>(i), own);
   });
   if (job.cancelled())
      return Error{ErrorCode::cancelled, "the export was cancelled"};
   for (const StrutLimit &piece : pieces)
      if (piece.radius < limit.radius)
         limit = piece;
   return limit;
}

} // namespace diatom
