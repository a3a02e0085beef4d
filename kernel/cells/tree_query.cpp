// Questions about the tree: content of blocks, equality, hashes and ordered walks.
#include "cells/tree.h"

#include <cstring>

namespace diatom::detail {

RootView viewRoot(const Block &root)
{
   if (root.empty())
      return {};
   const Node &node = *root.node();
   return {&asInner(node), blockOrigin(biased(node.bounds.min), node.level)};
}

Box contentBounds(const Block &block, Coord origin, int level)
{
   if (block.empty())
      return {};
   return block.isNode() ? block.node()->bounds : blockBox(origin, level);
}

std::uint64_t contentCount(const Block &block, int level)
{
   if (block.empty())
      return 0;
   return block.isNode() ? block.node()->count : blockCells(level);
}

namespace {

bool equalBricks(const Brick &a, const Brick &b)
{
   std::array<std::uint32_t, kBrickCells> cellsA, cellsB;
   a.decode(cellsA.data());
   b.decode(cellsB.data());
   return std::memcmp(cellsA.data(), cellsB.data(), sizeof cellsA) == 0;
}

} // namespace

bool equalBlocks(const Block &a, const Block &b)
{
   if (a.same(b))
      return true;
   if (!a.isNode() || !b.isNode())
      return false;
   const Node &m = *a.node(), &n = *b.node();
   if (m.level != n.level || m.count != n.count || m.bounds != n.bounds)
      return false;
   if (m.level == 0)
      return equalBricks(asBrick(m), asBrick(n));
   for (std::size_t c = 0; c < 64; ++c)
      if (!equalBlocks(asInner(m).children[c], asInner(n).children[c]))
         return false;
   return true;
}

Hash nodeHash(const Node &node)
{
   if (node.hashed.load(std::memory_order_acquire))
      return {node.hashHigh.load(std::memory_order_relaxed), node.hashLow.load(std::memory_order_relaxed)};
   Hasher hasher;
   hasher.add(node.level);
   if (node.level == 0) {
      std::array<std::uint32_t, kBrickCells> cells;
      asBrick(node).decode(cells.data());
      hasher.bytes(cells.data(), sizeof cells);
   } else {
      for (const Block &child : asInner(node).children) {
         hasher.add(child.isNode());
         if (child.isNode()) {
            const Hash hash = nodeHash(*child.node());
            hasher.add(hash.high);
            hasher.add(hash.low);
         } else {
            hasher.add(child.value());
         }
      }
   }
   const Hash hash = hasher.finish();
   // Threads that race here store the same bits.
   node.hashHigh.store(hash.high, std::memory_order_relaxed);
   node.hashLow.store(hash.low, std::memory_order_relaxed);
   node.hashed.store(true, std::memory_order_release);
   return hash;
}

std::uint64_t blockBytes(const Block &block)
{
   if (!block.isNode())
      return 0;
   if (block.node()->level == 0)
      return asBrick(*block.node()).bytes();
   std::uint64_t sum = sizeof(Inner);
   for (const Block &child : asInner(*block.node()).children)
      sum += blockBytes(child);
   return sum;
}

bool walk(const Block &block, Coord origin, int level, const Range &range,
          const std::function<bool(const Brick &, Coord)> &brick,
          const std::function<bool(std::uint32_t, Coord, int)> &tile)
{
   if (block.empty() || !range.meets(origin, level))
      return true;
   if (!block.isNode())
      return tile(block.value(), origin, level);
   if (level == 0)
      return brick(asBrick(*block.node()), origin);
   const Inner &inner = asInner(*block.node());
   for (unsigned c = 0; c < 64; ++c)
      if (!walk(inner.children[c], childOrigin(origin, level, c), level - 1, range, brick, tile))
         return false;
   return true;
}

} // namespace diatom::detail
