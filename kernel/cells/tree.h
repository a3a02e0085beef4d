// The tree behind a cell array: 16^3 bricks below inner nodes of 4x4x4 blocks. Internal to kernel/cells.
//
// Canonical form: a block of one value is never a node, and the root is the smallest inner node that holds
// all content. So equal contents have equal trees, however they came about.
#pragma once

#include "cells/block.h"
#include "cells/cell.h"
#include "core/hash.h"
#include "core/index.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace diatom::detail {

/// An index shifted to be positive. The bias puts index 0 in the middle of its block on every level, so that
/// content around the origin has a shallow tree: 0xAAAAAAA0 is child number 2 of 4 at each level above the
/// brick.
struct Coord
{
   std::uint32_t x = 0, y = 0, z = 0;
};

inline constexpr std::uint32_t kBias = 0xAAAAAAA0U;
inline constexpr int kTopLevel = 14; // side 2^32
inline constexpr unsigned kBrickSide = 16, kBrickCells = 4096;

constexpr Coord biased(Index i)
{
   return {static_cast<std::uint32_t>(i.x) + kBias, static_cast<std::uint32_t>(i.y) + kBias,
           static_cast<std::uint32_t>(i.z) + kBias};
}
constexpr Index unbiased(Coord u)
{
   return {static_cast<std::int32_t>(u.x - kBias), static_cast<std::int32_t>(u.y - kBias),
           static_cast<std::int32_t>(u.z - kBias)};
}
/// Base-2 logarithm of a block's side.
constexpr int sideShift(int level) { return 4 + 2 * level; }
/// Side minus one; also the mask of coordinates within the block.
constexpr std::uint32_t sideMask(int level)
{
   return static_cast<std::uint32_t>((std::uint64_t{1} << sideShift(level)) - 1);
}
constexpr Coord blockOrigin(Coord u, int level)
{
   const std::uint32_t keep = ~sideMask(level);
   return {u.x & keep, u.y & keep, u.z & keep};
}
/// Whether two coordinates are in the same block of a level.
constexpr bool sameBlock(Coord a, Coord b, int level)
{
   return (((a.x ^ b.x) | (a.y ^ b.y) | (a.z ^ b.z)) & ~sideMask(level)) == 0;
}
/// Which of the 64 blocks within the node of `level`, in the order of visits: x, then y, then z.
constexpr unsigned childNumber(Coord u, int level)
{
   const int shift = sideShift(level - 1);
   return ((u.x >> shift) & 3) << 4 | ((u.y >> shift) & 3) << 2 | ((u.z >> shift) & 3);
}
constexpr Coord childOrigin(Coord origin, int level, unsigned child)
{
   const int shift = sideShift(level - 1);
   return {origin.x + ((child >> 4) << shift), origin.y + (((child >> 2) & 3) << shift),
           origin.z + ((child & 3) << shift)};
}
constexpr unsigned brickCell(Coord u) { return (u.x & 15) << 8 | (u.y & 15) << 4 | (u.z & 15); }
/// Box of a whole block; only for blocks within the range of indices.
constexpr Box blockBox(Coord origin, int level)
{
   const std::uint32_t m = sideMask(level);
   return {unbiased(origin), unbiased({origin.x + m, origin.y + m, origin.z + m})};
}
/// Cells of a full block, saturated.
constexpr std::uint64_t blockCells(int level)
{
   return 3 * sideShift(level) >= 64 ? ~std::uint64_t{0} : std::uint64_t{1} << (3 * sideShift(level));
}

struct Node
{
   explicit Node(int nodeLevel) : level(static_cast<std::uint8_t>(nodeLevel)) {}
   Node(const Node &) = delete;
   Node &operator=(const Node &) = delete;

   mutable std::atomic<std::uint32_t> references{1};
   std::uint8_t level; // 0 = brick
   mutable std::atomic<bool> hashed{false};
   mutable std::atomic<std::uint64_t> hashHigh{0}, hashLow{0}; // valid when hashed
   std::uint64_t count = 0;                                    // saturates
   Box bounds;                                                 // tight
};

/// What setting a cell did.
struct Change
{
   bool changed = false;
   int added = 0; // cells: -1, 0, 1
};

/// 16^3 cells: numbers into a palette, packed to 1, 2, 4 or 8 bits; above 256 different values the values
/// themselves.
struct Brick : Node
{
   struct Entry
   {
      std::uint32_t value = 0, uses = 0;
   };
   static constexpr int kRaw = 5; // log2 of the bits of a value

   explicit Brick(std::uint32_t value, Coord origin);
   /// From 4096 packed cells.
   Brick(const std::uint32_t *cells, Coord origin);
   Brick(const Brick &other);

   std::uint32_t number(unsigned cell) const
   {
      const unsigned bit = cell << widthLog;
      return static_cast<std::uint32_t>(words[bit >> 6] >> (bit & 63)) & mask;
   }
   std::uint32_t at(unsigned cell) const
   {
      const std::uint32_t n = number(cell);
      return widthLog == kRaw ? n : palette[n].value;
   }
   void decode(std::uint32_t *cells) const;
   Change set(unsigned cell, Index i, std::uint32_t value);
   /// True when all 4096 cells have one value, which is put out.
   bool isUniform(std::uint32_t &value) const;
   std::uint64_t bytes() const;

   std::vector<Entry> palette; // empty when raw
   std::unique_ptr<std::uint64_t[]> words;
   std::uint32_t mask = 1;
   int widthLog = 0;

private:
   void encode(const std::uint32_t *cells, Coord origin);
   /// Palette and number of each cell; false when there are more than 256 values.
   bool findPalette(const std::uint32_t *cells, std::uint8_t *numbers);
   void measure(const std::uint32_t *cells, Coord origin);
   void allocate(int log);
   void put(unsigned cell, std::uint32_t number);
   std::uint32_t entryFor(std::uint32_t value);
   void widen();
   void shrinkBounds(Index erased);
};

struct Inner : Node
{
   explicit Inner(int nodeLevel) : Node(nodeLevel) {}
   std::array<Block, 64> children;
};

inline const Brick &asBrick(const Node &node) { return static_cast<const Brick &>(node); }
inline const Inner &asInner(const Node &node) { return static_cast<const Inner &>(node); }

/// Inclusive range of coordinates.
struct Range
{
   Coord low, high;
   bool covers(Coord origin, int level) const
   {
      const std::uint32_t m = sideMask(level);
      return low.x <= origin.x && low.y <= origin.y && low.z <= origin.z && origin.x + m <= high.x &&
             origin.y + m <= high.y && origin.z + m <= high.z;
   }
   bool meets(Coord origin, int level) const
   {
      const std::uint32_t m = sideMask(level);
      return low.x <= origin.x + m && high.x >= origin.x && low.y <= origin.y + m && high.y >= origin.y &&
             low.z <= origin.z + m && high.z >= origin.z;
   }
};
constexpr Range rangeOf(const Box &box) { return {biased(box.min), biased(box.max)}; }

// Edits of a root block (tree_edit.cpp). All keep the canonical form.
void setCell(Block &root, Index i, std::uint32_t value);
void fillRange(Block &root, const Range &range, std::uint32_t value);
/// Cells of the range from packed values in order x, y, z (z fastest).
void writeRange(Block &root, const Range &range, const Cell *cells);
void mapValues(Block &root, const std::function<std::uint32_t(std::uint32_t)> &map);

// Questions (tree_query.cpp).
struct RootView
{
   const Inner *node = nullptr; // null when empty
   Coord origin;
};
RootView viewRoot(const Block &root);
bool equalBlocks(const Block &a, const Block &b);
Hash nodeHash(const Node &node);
std::uint64_t blockBytes(const Block &block);
/// Bounds of a block's content.
Box contentBounds(const Block &block, Coord origin, int level);
std::uint64_t contentCount(const Block &block, int level);

/// Calls brick(const Brick &, origin) or tile(value, origin, level) for every block that holds content within
/// `range`, in order of visits; stops when one returns false.
bool walk(const Block &block, Coord origin, int level, const Range &range,
          const std::function<bool(const Brick &, Coord)> &brick,
          const std::function<bool(std::uint32_t, Coord, int)> &tile);

} // namespace diatom::detail
