// Solids for parts plugins: upright prisms over convex outlines that share whole edges. Only the faces
// between solid and empty are made, with common corners, so that the mesh is closed however the prisms are
// stacked.
#pragma once

#include <diatom/parts.hpp>

#include <cmath>
#include <map>

namespace diatom::sdk {
inline namespace v1 {

using Xy = std::array<double, 2>;

/// A convex outline, counter-clockwise seen from above; no three corners of it that follow each other from
/// the first on lie in a line with the first. Bit k of `solid`: there is matter between levels k and k + 1.
struct Prism
{
   std::vector<Xy> outline;
   std::uint32_t solid = 1;
};

class Prisms
{
public:
   /// `scale`: metres per unit of what is added.
   Prisms(PartMesh &mesh, double scale) : m_mesh(mesh), m_scale(scale) {}

   /// Adds the surface of prisms with common levels (rising). Prisms that meet share whole edges. Below the
   /// lowest and above the highest level there is nothing, or matter that is added by another call with the
   /// same corners round about.
   void add(const std::vector<double> &levels, const std::vector<Prism> &prisms, bool solidBelow = false,
            bool solidAbove = false)
   {
      const std::size_t layers = levels.size() - 1;
      const auto solid = [&](const Prism *prism, std::size_t layer) {
         return prism && (prism->solid >> layer & 1) != 0;
      };
      std::map<std::pair<std::int32_t, std::int32_t>, const Prism *>
          owner; // by directed edge on the lowest level
      for (const Prism &prism : prisms)
         for (std::size_t k = 0; k < prism.outline.size(); ++k)
            owner[{point(prism.outline[k]), point(prism.outline[(k + 1) % prism.outline.size()])}] = &prism;
      for (const auto &[edge, prism] : owner) {
         const auto across = owner.find({edge.second, edge.first});
         const Prism *other = across == owner.end() ? nullptr : across->second;
         for (std::size_t layer = 0; layer < layers; ++layer)
            if (solid(prism, layer) && !solid(other, layer)) {
               const double low = levels[layer], high = levels[layer + 1];
               m_mesh.quad(corner(edge.first, low), corner(edge.second, low), corner(edge.second, high),
                           corner(edge.first, high));
            }
      }
      for (const Prism &prism : prisms)
         for (std::size_t level = 0; level <= layers; ++level) {
            const bool below = level == 0 ? solidBelow : solid(&prism, level - 1);
            const bool above = level == layers ? solidAbove : solid(&prism, level);
            for (std::size_t k = 2; below != above && k < prism.outline.size(); ++k) {
               const std::int32_t a = corner(point(prism.outline[0]), levels[level]),
                                  b = corner(point(prism.outline[k - 1]), levels[level]),
                                  c = corner(point(prism.outline[k]), levels[level]);
               below ? m_mesh.triangle(a, b, c) : m_mesh.triangle(a, c, b);
            }
         }
   }

private:
   static std::int64_t rounded(double v) { return std::llround(v * 1e9); }
   std::int32_t point(Xy at)
   {
      const auto [found, fresh] =
          m_points.try_emplace({rounded(at[0]), rounded(at[1])}, static_cast<std::int32_t>(m_places.size()));
      if (fresh)
         m_places.push_back(at);
      return found->second;
   }
   std::int32_t corner(std::int32_t point, double level)
   {
      const auto [found, fresh] = m_corners.try_emplace({point, rounded(level)}, 0);
      if (fresh) {
         const Xy &at = m_places[static_cast<std::size_t>(point)];
         found->second = m_mesh.vertex(at[0] * m_scale, at[1] * m_scale, level * m_scale);
      }
      return found->second;
   }

   PartMesh &m_mesh;
   double m_scale;
   std::vector<Xy> m_places;
   std::map<std::array<std::int64_t, 2>, std::int32_t> m_points;
   std::map<std::pair<std::int32_t, std::int64_t>, std::int32_t> m_corners;
};

/// A round outline of `count` corners, a multiple of four, the first on the x axis.
inline std::vector<Xy> circle(Xy middle, double radius, int count)
{
   std::vector<Xy> points;
   for (int k = 0; k < count; ++k) {
      const double angle = 2 * std::acos(-1.0) * k / count;
      points.push_back({middle[0] + radius * std::cos(angle), middle[1] + radius * std::sin(angle)});
   }
   return points;
}

/// Triangles between a rectangle and a circle() within it.
inline void addSurround(std::vector<Prism> &prisms, Xy low, Xy high, const std::vector<Xy> &round,
                        std::uint32_t solid)
{
   const std::size_t quarter = round.size() / 4;
   const Xy corners[4] = {high, {low[0], high[1]}, low, {high[0], low[1]}};
   for (std::size_t k = 0; k < 4; ++k) {
      prisms.push_back({{corners[(k + 3) % 4], corners[k], round[k * quarter]}, solid});
      for (std::size_t n = k * quarter; n < (k + 1) * quarter; ++n)
         prisms.push_back({{corners[k], round[(n + 1) % round.size()], round[n]}, solid});
   }
}

} // namespace v1
} // namespace diatom::sdk
