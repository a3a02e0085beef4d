#include "io/strut_graph.h"

#include "io/point_numbers.h"
#include "io/strut_crossings.h"
#include "io/surface_tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

namespace diatom {

namespace {

class GraphMaker
{
public:
   GraphMaker(const Hierarchy &hierarchy, bool connections, const Job &job)
       : m_hierarchy(hierarchy), m_lattice(hierarchy.lattice()), m_tables(m_lattice),
         m_connections(connections), m_job(job)
   {}

   Result<StrutGraph> run()
   {
      const bool overlaps = m_hierarchy.depth() > 1;
      std::uint64_t seen = 0;
      const bool whole = m_hierarchy.visit(m_hierarchy.bounds(), [&](Index i, Cell cell) {
         if (++seen % 4096 == 0) {
            m_job.progress(static_cast<double>(seen) / static_cast<double>(m_hierarchy.cells()),
                           "finding struts");
            if (m_job.cancelled())
               return false;
         }
         // Where several cells overlap, the one the hierarchy shows.
         if (overlaps && m_hierarchy.at(i).material != cell.material)
            return true;
         m_connections ? connect(i, cell.material) : edges(i, cell.material);
         return m_graph.nodes.size() < kMost && m_lines.size() < kMost;
      });
      if (m_job.cancelled())
         return Error{ErrorCode::cancelled, "the export was cancelled"};
      if (!whole)
         return Error{ErrorCode::invalid,
                      "the design has more struts than a mesh with indices can count; export "
                      "it in pieces"};
      finish();
      if (m_job.cancelled())
         return Error{ErrorCode::cancelled, "the export was cancelled"};
      return std::move(m_graph);
   }

private:
   static constexpr std::size_t kMost = 1u << 28; // each makes several vertices

   void edges(Index i, MaterialIndex material)
   {
      const int site = m_lattice.site(i);
      const auto &owners = m_tables.corners(site);
      for (const auto &[from, to] : m_lattice.shape(site).edges)
         strut(m_tables.corner(i, owners[static_cast<std::size_t>(from)]),
               m_tables.corner(i, owners[static_cast<std::size_t>(to)]), material);
   }

   void connect(Index i, MaterialIndex material)
   {
      for (const Link &link : m_lattice.links(m_lattice.site(i))) {
         const Index other = i + link.offset;
         if (link.joined && other < i && inRange(other))
            if (const MaterialIndex across = m_hierarchy.at(other).material; across != 0)
               strut(m_lattice.position(i), m_lattice.position(other), std::min(material, across));
      }
   }

   void strut(const Vec3 &from, const Vec3 &to, MaterialIndex material)
   {
      std::uint32_t a = m_numbers.number(from, m_graph.nodes);
      std::uint32_t b = m_numbers.number(to, m_graph.nodes);
      if (b < a)
         std::swap(a, b);
      const auto [found, added] = m_known.emplace(std::uint64_t{a} << 32 | b, m_lines.size());
      if (added)
         m_lines.push_back({a, b, material});
      else
         m_lines[found->second].material = std::min(m_lines[found->second].material, material);
   }

   void finish()
   {
      for (const StrutLine &line : cutAtCrossings(m_lines, m_graph.nodes, m_job)) {
         Vec3 along = (m_graph.nodes[line.b] - m_graph.nodes[line.a]).normalized();
         constexpr double kSmall = 1e-6;
         int first = 0;
         while (first < 2 && std::abs(along[first]) < kSmall)
            ++first;
         const bool reversed = along[first] < 0;
         if (reversed)
            along = -along;
         m_graph.struts.push_back({line.a, line.b, axis(along), reversed, line.material});
      }
      m_graph.at.resize(m_graph.nodes.size());
      for (std::uint32_t s = 0; s < m_graph.struts.size(); ++s) {
         m_graph.at[m_graph.struts[s].a].push_back(s);
         m_graph.at[m_graph.struts[s].b].push_back(s);
      }
   }

   /// Directions that differ by rounding only are one.
   int axis(const Vec3 &along)
   {
      std::array<long long, 3> key{};
      for (int k = 0; k < 3; ++k)
         key[static_cast<std::size_t>(k)] = std::llround(along[k] * 1e5);
      const auto [found, added] = m_axes.emplace(key, static_cast<int>(m_graph.axes.size()));
      if (added) {
         Vec3 across = Vec3::UnitZ().cross(along);
         if (across.norm() < 1e-3)
            across = Vec3::UnitX();
         across = (across - along * along.dot(across)).normalized();
         m_graph.axes.push_back({along, across, along.cross(across)});
      }
      return found->second;
   }

   const Hierarchy &m_hierarchy;
   const Lattice &m_lattice;
   SurfaceTables m_tables;
   bool m_connections;
   const Job &m_job;
   std::vector<StrutLine> m_lines;
   StrutGraph m_graph;
   PointNumbers m_numbers;
   std::unordered_map<std::uint64_t, std::size_t> m_known;
   std::map<std::array<long long, 3>, int> m_axes;
};

} // namespace

Result<StrutGraph> strutGraph(const Hierarchy &hierarchy, bool connections, const Job &job)
{
   return GraphMaker(hierarchy, connections, job).run();
}

} // namespace diatom
