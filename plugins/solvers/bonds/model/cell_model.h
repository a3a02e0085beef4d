// How a cell takes part, as a beam, in a dense block or as a solid; and which cells lie around it.
#pragma once

#include <diatom/solver.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace bonds {

enum class CellModel : std::uint8_t { bond, block, solid };

/// The property "cell_model" of a material; a bond where it has none. A scene whose effects leave "solid" out
/// has bonds in place of solids.
CellModel cellModelOf(const diatom::sdk::SceneView &scene, std::int32_t material);

/// Whether a material brings bond constants of its own, which say all that is known of it.
bool hasOwnConstants(const diatom::sdk::SceneView &scene, std::int32_t material);

/// The cells joined to each cell along the world axes.
class Neighbours
{
public:
   explicit Neighbours(std::int64_t cells);
   /// b lies in direction +axis of a.
   void join(std::int32_t a, std::int32_t b, int axis);
   /// Side 0 lies towards -axis, 1 towards +axis; -1 where nothing is joined.
   std::int32_t at(std::int64_t cell, int axis, int side) const { return m_next[cell][2 * axis + side]; }
   /// Whether the bond from a along +axis to b is an edge of a square of four joined cells, all of which
   /// `counts` holds for, that reaches out along `across`.
   template<typename Counts>
   bool squared(std::int64_t a, std::int64_t b, int axis, int across, const Counts &counts) const
   {
      for (int side = 0; side < 2; ++side) {
         const std::int32_t c = at(a, across, side), d = at(b, across, side);
         if (c >= 0 && d >= 0 && at(c, axis, 1) == d && counts(c) && counts(d))
            return counts(a) && counts(b);
      }
      return false;
   }

private:
   std::vector<std::array<std::int32_t, 6>> m_next;
};

} // namespace bonds
