// What is known of a definition (or the root) without looking into it again. Internal to kernel/cells.
#pragma once

#include "cells/hierarchy.h"
#include "cells/placing.h"

#include <array>
#include <mutex>

namespace diatom {

namespace detail {

/// Boxes in a tree of 16-fold groups in their given order, so that neighbours in the order should be
/// neighbours in space.
class BoxTree
{
public:
   explicit BoxTree(std::vector<Box> boxes = {});
   Box bounds() const;
   /// Calls leaf(number) in order for every box that `enter` (box) accepts with all its groups; stops on
   /// false.
   template<typename Enter, typename Leaf>
   bool visit(const Enter &enter, const Leaf &leaf) const
   {
      return m_levels.empty() || visitGroup(m_levels.size() - 1, 0, m_levels.back().size(), enter, leaf);
   }

private:
   static constexpr std::size_t kGroup = 16;
   template<typename Enter, typename Leaf>
   bool visitGroup(std::size_t level, std::size_t begin, std::size_t end, const Enter &enter,
                   const Leaf &leaf) const
   {
      for (std::size_t n = begin; n < end; ++n) {
         if (!enter(m_levels[level][n]))
            continue;
         const bool on =
             level == 0 ? leaf(n)
                        : visitGroup(level - 1, n * kGroup,
                                     std::min((n + 1) * kGroup, m_levels[level - 1].size()), enter, leaf);
         if (!on)
            return false;
      }
      return true;
   }
   std::vector<std::vector<Box>> m_levels; // 0 = the boxes themselves
};

/// Cells of one material: how many, their volume, and the integral of (position - position of index 0) over
/// it.
struct Moment
{
   std::uint64_t count = 0;
   double volume = 0;
   Vec3 first = Vec3::Zero();
};

} // namespace detail

struct Hierarchy::Summary
{
   /// All instances of one definition and rotation whose origins have the same site fill the same box about
   /// their origin.
   struct Kind
   {
      DefinitionId definition = 0;
      std::uint8_t rotation = 0;
      int site = 0;
      std::shared_ptr<const Summary> summary;
      Box box; // minus origin

      Box boxAt(Index origin) const { return {box.min + origin, box.max + origin}; }
   };

   Body body;
   std::uint64_t count = 0, stored = 0;
   int depth = 1;
   Box bounds;
   std::vector<Kind> kinds;
   std::vector<std::vector<std::uint32_t>>
       kindOf; // per chunk and placement; kSkipped where the placement means nothing
   detail::BoxTree chunkBoxes;

   static constexpr std::uint32_t kSkipped = ~std::uint32_t{0};

   /// Logical cells by material, instances included; computed at first use.
   const std::vector<detail::Moment> &moments(const detail::Placing &placing) const;

private:
   std::vector<detail::Moment> sumMoments(const detail::Placing &placing) const;
   mutable std::once_flag m_once;
   mutable std::vector<detail::Moment> m_moments;
};

namespace detail {

/// Moments of the array's own cells.
std::vector<Moment> cellMoments(const CellArray &cells, const Placing &placing);
/// Exact box of the array's cells after placing.
Box placedBounds(const CellArray &cells, const Placement &placement, const Placing &placing);

} // namespace detail

} // namespace diatom
