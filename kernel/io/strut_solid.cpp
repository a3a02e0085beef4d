#include "io/strut_solid.h"

#include "io/node_hull.h"
#include "io/strut_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <unordered_map>

namespace diatom {

namespace {

constexpr double kOfShortest = 0.2, kOfWidest = 0.6;

/// Radius of the circle round a section over its width.
double radiusOverWidth(int sides) { return sides == 4 ? std::sqrt(0.5) : 0.5; }

/// To nine digits: lengths are differences of places, and 0.1999999999999998 helps nobody.
double rounded(double length)
{
   if (!(length > 0))
      return length;
   const double scale = std::pow(10, 8 - std::floor(std::log10(length)));
   return std::round(length * scale) / scale;
}

class StrutMaker
{
public:
   StrutMaker(const StrutGraph &graph, const StrutOptions &options, bool apart, double width)
       : m_graph(graph), m_sides(options.sides), m_apart(apart), m_overlapping(options.overlapping),
         m_radius(width * radiusOverWidth(options.sides))
   {
      for (const StrutAxis &axis : graph.axes)
         for (int k = 0; k < m_sides; ++k) {
            const double angle = (2 * k + 1) * std::numbers::pi / m_sides; // a flat side across
            m_rim.push_back(m_radius * (std::cos(angle) * axis.across + std::sin(angle) * axis.third));
         }
   }

   Result<std::map<MaterialIndex, SolidMesh>> run(const Job &job)
   {
      m_setBacks = m_overlapping ? std::vector<double>(m_graph.nodes.size(), 0.0) : setBacks(m_graph);
      for (std::uint32_t s = 0; s < m_graph.struts.size(); ++s) {
         if (s % 4096 == 0 && stopped(job, s, m_graph.struts.size()))
            return Error{ErrorCode::cancelled, "the export was cancelled"};
         strut(s);
      }
      if (!m_overlapping)
         for (std::uint32_t n = 0; n < m_graph.nodes.size(); ++n)
            if (!node(n)) {
               const Vec3 &at = m_graph.nodes[n];
               return Error{ErrorCode::internal,
                            fmt::format("the joint at ({:.6g}, {:.6g}, {:.6g}) m could not be made; choose "
                                        "another --strut-width or --overlapping",
                                        at.x(), at.y(), at.z())};
            }
      std::map<MaterialIndex, SolidMesh> solids;
      for (auto &[material, part] : m_parts)
         solids.emplace(material, std::move(part.mesh));
      return solids;
   }

private:
   struct Part
   {
      SolidMesh mesh;
      std::unordered_map<std::uint64_t, std::uint32_t> numbers; // of corners
   };

   static bool stopped(const Job &job, std::size_t done, std::size_t all)
   {
      job.progress(static_cast<double>(done) / static_cast<double>(all), "making struts");
      return job.cancelled();
   }

   /// A corner of a strut's end: at its node a (end 0) or b (end 1).
   std::uint64_t corner(std::uint32_t s, int end, int k) const
   {
      return (std::uint64_t{s} * 2 + static_cast<std::uint64_t>(end)) * static_cast<std::uint64_t>(m_sides) +
             static_cast<std::uint64_t>(k);
   }

   Vec3 place(std::uint64_t corner) const
   {
      const auto sides = static_cast<std::uint64_t>(m_sides);
      const auto end = corner / sides % 2;
      const Strut &strut = m_graph.struts[corner / sides / 2];
      const std::uint32_t node = end ? strut.b : strut.a;
      return m_graph.nodes[node] + m_graph.leaving(strut, node) * (m_setBacks[node] * m_radius) +
             rim(strut, static_cast<int>(corner % sides));
   }

   const Vec3 &rim(const Strut &strut, int k) const
   {
      return m_rim[static_cast<std::size_t>(strut.axis) * static_cast<std::size_t>(m_sides) +
                   static_cast<std::size_t>(k)];
   }

   void face(MaterialIndex material, std::span<const std::uint64_t> corners)
   {
      Part &part = m_parts[m_apart ? material : MaterialIndex{0}];
      m_ring.clear();
      for (const std::uint64_t at : corners) {
         const auto [found, added] =
             part.numbers.emplace(at, static_cast<std::uint32_t>(part.mesh.vertices.size()));
         if (added)
            part.mesh.vertices.push_back(place(at));
         m_ring.push_back(found->second);
      }
      for (std::size_t i = 2; i < m_ring.size(); ++i) {
         part.mesh.triangles.push_back({m_ring[0], m_ring[i - 1], m_ring[i]});
         part.mesh.materials.push_back(material);
      }
   }

   /// End polygon of a strut, counter-clockwise seen from within the strut (`inner`), or from the node.
   std::vector<std::uint64_t> endFace(std::uint32_t s, int end, bool inner) const
   {
      const Strut &strut = m_graph.struts[s];
      const bool leavesAlong = (end == 0) != strut.reversed;
      std::vector<std::uint64_t> ring;
      for (int k = 0; k < m_sides; ++k)
         ring.push_back(corner(s, end, leavesAlong == inner ? k : m_sides - 1 - k));
      return ring;
   }

   MaterialIndex materialOf(std::uint32_t n) const
   {
      MaterialIndex least = m_graph.struts[m_graph.at[n][0]].material;
      for (const std::uint32_t s : m_graph.at[n])
         least = std::min(least, m_graph.struts[s].material);
      return least;
   }

   void strut(std::uint32_t s)
   {
      const Strut &strut = m_graph.struts[s];
      for (int k = 0; k < m_sides; ++k) {
         const int next = (k + 1) % m_sides;
         const int low = strut.reversed ? 1 : 0, high = 1 - low; // ends along the axis
         const std::uint64_t quad[4] = {corner(s, low, k), corner(s, low, next), corner(s, high, next),
                                        corner(s, high, k)};
         face(strut.material, quad);
      }
      for (int end = 0; end < 2; ++end) {
         const std::uint32_t n = end ? strut.b : strut.a;
         const bool free = m_overlapping || m_graph.at[n].size() == 1;
         if (free || (m_apart && materialOf(n) != strut.material))
            face(strut.material, endFace(s, end, false));
      }
   }

   bool node(std::uint32_t n)
   {
      const auto &ends = m_graph.at[n];
      if (ends.size() < 2)
         return true;
      const MaterialIndex material = materialOf(n);
      std::vector<std::uint64_t> corners; // end polygons one after the other, counter-clockwise from outside
      std::vector<int> kind;
      for (const std::uint32_t s : ends) {
         const int end = m_graph.struts[s].a == n ? 0 : 1;
         const auto ring = endFace(s, end, true);
         corners.insert(corners.end(), ring.begin(), ring.end());
         kind.push_back(2 * m_graph.struts[s].axis + ((end == 0) != m_graph.struts[s].reversed ? 0 : 1));
         if (m_apart && m_graph.struts[s].material != material)
            face(material, ring);
      }
      const auto faces = joint(n, kind, corners);
      if (!faces)
         return false;
      std::vector<std::uint64_t> ring;
      for (const auto &each : *faces) {
         ring.clear();
         for (const int k : each)
            ring.push_back(corners[static_cast<std::size_t>(k)]);
         face(material, ring);
      }
      return true;
   }

   /// Joints with struts in the same directions, in the same order, are made once.
   const std::vector<std::vector<int>> *joint(std::uint32_t n, const std::vector<int> &kind,
                                              const std::vector<std::uint64_t> &corners)
   {
      const auto known = m_joints.find(kind);
      if (known != m_joints.end())
         return &known->second;
      std::vector<Vec3> points;
      for (const std::uint64_t at : corners)
         points.push_back(place(at) - m_graph.nodes[n]);
      auto faces = joiningFaces(points, static_cast<int>(kind.size()), m_sides);
      return faces ? &m_joints.emplace(kind, *std::move(faces)).first->second : nullptr;
   }

   const StrutGraph &m_graph;
   int m_sides;
   bool m_apart, m_overlapping;
   double m_radius;
   std::vector<Vec3> m_rim; // by axis and corner
   std::vector<double> m_setBacks;
   std::map<MaterialIndex, Part> m_parts;
   std::map<std::vector<int>, std::vector<std::vector<int>>> m_joints;
   std::vector<std::uint32_t> m_ring;
};

} // namespace

Result<StrutFacts> strutFacts(const StrutGraph &graph, const StrutOptions &options, const Job &job)
{
   if (options.sides < 3 || options.sides > 64)
      return Error{ErrorCode::usage, "a strut's section has 3 to 64 sides"};
   if (!(options.width >= 0) || !std::isfinite(options.width))
      return Error{ErrorCode::usage, "the width of struts must be a positive length"};
   StrutFacts facts;
   facts.struts = graph.struts.size();
   facts.nodes = graph.nodes.size();
   if (graph.struts.empty())
      return facts;
   double shortest = graph.length(graph.struts[0]);
   for (const Strut &strut : graph.struts)
      shortest = std::min(shortest, graph.length(strut));
   facts.width = options.width > 0 ? options.width : rounded(kOfShortest * shortest);
   if (options.overlapping || options.beams)
      return facts;
   const auto limit = strutLimit(graph, setBacks(graph), job);
   if (!limit)
      return limit.error();
   facts.widest = limit->radius / radiusOverWidth(options.sides);
   if (options.width <= 0)
      facts.width = std::min(facts.width, rounded(kOfWidest * facts.widest));
   const Vec3 at = limit->where * 1e3;
   const std::string where = fmt::format("({:.6g}, {:.6g}, {:.6g}) mm", at.x(), at.y(), at.z());
   if (facts.widest < 1e-6 * shortest)
      return Error{ErrorCode::invalid,
                   fmt::format("struts cross or lie on each other at {}, where they share no "
                               "node; choose --overlapping",
                               where)};
   if (facts.width > facts.widest)
      return Error{
          ErrorCode::invalid,
          fmt::format("struts {:.6g} mm wide are too thick: {} {}; give --strut-width up to {:.6g}mm, or "
                      "--overlapping",
                      facts.width * 1e3,
                      limit->crossing ? "struts or joints that share no node would meet at"
                                      : "the joints at its ends would use up the whole strut at",
                      where, std::floor(facts.widest * 1e9) / 1e6)};
   return facts;
}

Result<std::map<MaterialIndex, SolidMesh>> strutSolids(const StrutGraph &graph, const StrutOptions &options,
                                                       bool apart, StrutFacts &facts, const Job &job)
{
   const auto known = strutFacts(graph, options, job);
   if (!known)
      return known.error();
   facts = *known;
   constexpr std::uint64_t kMost = 0xffff'ffffu / 3;
   if (graph.struts.size() * static_cast<std::uint64_t>(options.sides) * 6 > kMost)
      return Error{ErrorCode::invalid,
                   "the struts have more triangles than a mesh with indices can count; export "
                   "them in pieces or with fewer --strut-sides"};
   return StrutMaker(graph, options, apart, facts.width).run(job);
}

} // namespace diatom
