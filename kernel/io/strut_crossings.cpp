#include "io/strut_crossings.h"

#include "io/place_grid.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace diatom {

namespace {

/// A line, where along it (0 to 1), and the node there.
struct Cut
{
   std::uint32_t line;
   double at;
   std::uint32_t node;
};

struct Crossing
{
   std::uint32_t one, other;
   double atOne, atOther;
};

class Crossings
{
public:
   Crossings(const std::vector<StrutLine> &lines, std::vector<Vec3> &nodes) : m_lines(lines), m_nodes(nodes)
   {
      for (const StrutLine &line : lines)
         m_longest = std::max(m_longest, along(line).norm());
      m_tolerance = 1e-6 * m_longest;
      m_grid = PlaceGrid(m_longest);
      for (std::uint32_t i = 0; i < lines.size(); ++i)
         m_grid.add(middle(lines[i]), i);
   }

   void find(const Job &job)
   {
      constexpr std::int64_t kGrain = 4096;
      const auto count = static_cast<std::int64_t>(m_lines.size());
      struct Found
      {
         std::vector<Cut> cuts;
         std::vector<Crossing> crossings;
      };
      std::vector<Found> pieces(static_cast<std::size_t>((count + kGrain - 1) / kGrain));
      job.parallelFor(count, kGrain, [&](std::int64_t begin, std::int64_t end) {
         Found &own = pieces[static_cast<std::size_t>(begin / kGrain)];
         for (std::int64_t i = begin; i < end && !job.cancelled(); ++i)
            m_grid.near(middle(m_lines[static_cast<std::size_t>(i)]), [&](std::uint32_t j) {
               if (j < i)
                  meet(static_cast<std::uint32_t>(i), j, own.cuts, own.crossings);
            });
      });
      PlaceGrid made(m_longest);
      for (const Found &piece : pieces) {
         m_cuts.insert(m_cuts.end(), piece.cuts.begin(), piece.cuts.end());
         for (const Crossing &crossing : piece.crossings) {
            const std::uint32_t node = nodeAt(crossing, made);
            m_cuts.push_back({crossing.one, crossing.atOne, node});
            m_cuts.push_back({crossing.other, crossing.atOther, node});
         }
      }
   }

   std::vector<StrutLine> cut()
   {
      std::stable_sort(m_cuts.begin(), m_cuts.end(), [](const Cut &a, const Cut &b) {
         return a.line != b.line ? a.line < b.line : a.at < b.at;
      });
      std::size_t next = 0;
      for (std::uint32_t i = 0; i < m_lines.size(); ++i) {
         std::uint32_t from = m_lines[i].a;
         for (; next < m_cuts.size() && m_cuts[next].line == i; ++next) {
            piece(from, m_cuts[next].node, m_lines[i].material);
            from = m_cuts[next].node;
         }
         piece(from, m_lines[i].b, m_lines[i].material);
      }
      return std::move(m_pieces);
   }

private:
   Vec3 along(const StrutLine &line) const { return m_nodes[line.b] - m_nodes[line.a]; }
   Vec3 middle(const StrutLine &line) const { return (m_nodes[line.a] + m_nodes[line.b]) / 2; }

   void meet(std::uint32_t i, std::uint32_t j, std::vector<Cut> &cuts, std::vector<Crossing> &crossings) const
   {
      const StrutLine &one = m_lines[i], &other = m_lines[j];
      const Vec3 u = along(one), v = along(other);
      if ((middle(one) - middle(other)).norm() > (u.norm() + v.norm()) / 2 + m_tolerance)
         return;
      bool touched = false;
      for (const auto &[line, node] :
           {std::pair(i, other.a), std::pair(i, other.b), std::pair(j, one.a), std::pair(j, one.b)})
         touched = endsOn(line, node, cuts) || touched;
      if (touched || one.a == other.a || one.a == other.b || one.b == other.a || one.b == other.b)
         return;
      const Vec3 normal = u.cross(v), w = m_nodes[other.a] - m_nodes[one.a];
      const double size = normal.squaredNorm();
      if (size < 1e-12 * u.squaredNorm() * v.squaredNorm())
         return;
      const double s = w.cross(v).dot(normal) / size, t = w.cross(u).dot(normal) / size;
      if (s > 0 && s < 1 && t > 0 && t < 1 && (w + t * v - s * u).norm() < m_tolerance)
         crossings.push_back({i, j, s, t});
   }

   /// Whether the node lies within the line; then it is cut there.
   bool endsOn(std::uint32_t i, std::uint32_t node, std::vector<Cut> &cuts) const
   {
      const StrutLine &line = m_lines[i];
      if (node == line.a || node == line.b)
         return false;
      const Vec3 u = along(line), to = m_nodes[node] - m_nodes[line.a];
      const double at = u.dot(to) / u.squaredNorm();
      if (at <= 0 || at >= 1 || (to - at * u).norm() > m_tolerance)
         return false;
      cuts.push_back({i, at, node});
      return true;
   }

   std::uint32_t nodeAt(const Crossing &crossing, PlaceGrid &made)
   {
      const StrutLine &line = m_lines[crossing.one];
      const Vec3 place = m_nodes[line.a] + crossing.atOne * along(line);
      std::uint32_t found = static_cast<std::uint32_t>(m_nodes.size());
      made.near(place, [&](std::uint32_t node) {
         if ((m_nodes[node] - place).norm() < 2 * m_tolerance)
            found = std::min(found, node);
      });
      if (found == m_nodes.size()) {
         m_nodes.push_back(place);
         made.add(place, found);
      }
      return found;
   }

   void piece(std::uint32_t a, std::uint32_t b, MaterialIndex material)
   {
      if (a == b)
         return; // two lines cut this one at the same node
      if (b < a)
         std::swap(a, b);
      const auto [found, added] = m_known.emplace(std::uint64_t{a} << 32 | b, m_pieces.size());
      if (added)
         m_pieces.push_back({a, b, material});
      else
         m_pieces[found->second].material = std::min(m_pieces[found->second].material, material);
   }

   const std::vector<StrutLine> &m_lines;
   std::vector<Vec3> &m_nodes;
   double m_longest = 0, m_tolerance = 0;
   PlaceGrid m_grid{1};
   std::vector<Cut> m_cuts;
   std::vector<StrutLine> m_pieces;
   std::unordered_map<std::uint64_t, std::size_t> m_known;
};

} // namespace

std::vector<StrutLine> cutAtCrossings(const std::vector<StrutLine> &lines, std::vector<Vec3> &nodes,
                                      const Job &job)
{
   Crossings crossings(lines, nodes);
   crossings.find(job);
   return crossings.cut();
}

} // namespace diatom
