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

/// First b, then a.
inline Wxyz turned(const Wxyz &a, const Wxyz &b)
{
   return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
           a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
           a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
           a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

/// Index of a cell as text, for messages.
inline std::string cellName(const diatom_cells &cells, std::int64_t cell)
{
   const std::int32_t *index = cells.index + 3 * cell;
   return std::to_string(index[0]) + " " + std::to_string(index[1]) + " " + std::to_string(index[2]);
}

/// Cells of each run in their order. A run of two materials, or one longer than `longest` (0 = any), is
/// refused.
inline std::vector<std::vector<std::int64_t>> runsOf(const Call &call, const diatom_cells &cells,
                                                     std::size_t longest = 0)
{
   std::vector<std::vector<std::int64_t>> all(static_cast<std::size_t>(cells.count));
   for (std::int64_t i = 0; i < cells.count; ++i) {
      pollEvery(call, i);
      auto &run = all[static_cast<std::size_t>(cells.supercell[i])];
      const auto place = static_cast<std::size_t>(cells.place[i]);
      if (run.size() <= place)
         run.resize(place + 1, -1);
      run[place] = i;
   }
   std::vector<std::vector<std::int64_t>> runs;
   for (auto &run : all) {
      if (run.empty())
         continue;
      const std::int64_t first = run.front();
      for (const std::int64_t cell : run)
         if (cells.material[cell] != cells.material[first])
            throw Failure(DIATOM_BAD_INPUT, "the brick that starts at cell " + cellName(cells, first) +
                                                " has a second material at cell " + cellName(cells, cell) +
                                                "; a brick is made of one");
      if (longest > 0 && run.size() > longest)
         throw Failure(DIATOM_BAD_INPUT, "the brick that starts at cell " + cellName(cells, first) + " is " +
                                             std::to_string(run.size()) + " cells long; at most " +
                                             std::to_string(longest) + " can be made");
      runs.push_back(std::move(run));
   }
   return runs;
}

/// Refuses cells whose layers are not `height` lattice units apart: the parts would not fit together.
inline void needHeight(const diatom_cells &cells, double height, const char *parts)
{
   for (std::int64_t i = 0; i < cells.count; ++i) {
      const double layer = cells.index[3 * i + 2], z = cells.position[3 * i + 2] / cells.pitch;
      if (std::abs(z - layer * height) > 1e-6 * std::abs(layer) * height)
         throw Failure(DIATOM_BAD_INPUT, std::string(parts) + " need cells " +
                                             std::to_string(height).substr(0, 4) +
                                             " of their width high; set the lattice's height to that");
   }
}

/// Bricks of a lattice whose runs go along +y in even layers (site 0) and along +x in odd ones
/// (dmdesign.md 1.3, the deployed rule), each part laid along its run's +x.
inline Wxyz alongRun(std::int32_t site)
{
   return site == 0 ? Wxyz{std::sqrt(0.5), 0, 0, std::sqrt(0.5)} : Wxyz{1, 0, 0, 0};
}

} // namespace v1
} // namespace diatom::sdk
