// Edits of the tree: path copying, in place where this array is the only owner of the whole path.
#include "cells/tree.h"
#include "core/check.h"

#include <algorithm>

namespace diatom::detail {

void Block::retainNode() const { node()->references.fetch_add(1, std::memory_order_relaxed); }

void Block::releaseNode()
{
   // Acquire and release: the last owner, and one that finds itself the only owner, see all reads of the
   // others done.
   if (node()->references.fetch_sub(1, std::memory_order_acq_rel) != 1)
      return;
   if (node()->level == 0)
      delete static_cast<const Brick *>(node());
   else
      delete static_cast<const Inner *>(node());
}

namespace {

Node *newNode(std::uint32_t value, int level, Coord origin)
{
   if (level == 0)
      return new Brick(value, origin);
   auto *inner = new Inner(level);
   if (value != 0) {
      inner->children.fill(Block::uniform(value));
      inner->count = blockCells(level);
      inner->bounds = blockBox(origin, level);
   }
   return inner;
}

Node *cloneNode(const Node &node)
{
   if (node.level == 0)
      return new Brick(asBrick(node));
   auto *inner = new Inner(node.level);
   inner->children = asInner(node).children;
   inner->count = node.count;
   inner->bounds = node.bounds;
   return inner;
}

/// The block's node, owned by this tree alone. A shared parent was copied before, which made its children
/// shared: one reference here means that no other tree reaches the node.
Node &writable(Block &slot, int level, Coord origin)
{
   if (!slot.isNode())
      slot = Block::own(newNode(slot.value(), level, origin));
   else if (slot.node()->references.load(std::memory_order_acquire) != 1)
      slot = Block::own(cloneNode(*slot.node()));
   Node &node = *slot.mutableNode();
   node.hashed.store(false, std::memory_order_relaxed);
   return node;
}

/// Bounds and, when it may have saturated, count from the children.
void summariseBounds(Inner &inner, Coord origin)
{
   inner.bounds = Box();
   for (unsigned c = 0; c < 64; ++c)
      if (!inner.children[c].empty())
         inner.bounds.extend(
             contentBounds(inner.children[c], childOrigin(origin, inner.level, c), inner.level - 1));
}

void summariseCount(Inner &inner)
{
   std::uint64_t sum = 0;
   for (const Block &child : inner.children) {
      const std::uint64_t n = contentCount(child, inner.level - 1);
      sum = sum + n < sum ? ~std::uint64_t{0} : sum + n;
   }
   inner.count = sum;
}

/// Whether all children are one value, which is put out.
bool isUniform(const Inner &inner, std::uint32_t &value)
{
   const Block &first = inner.children[0];
   if (first.isNode() || inner.count != blockCells(inner.level))
      return false;
   for (const Block &child : inner.children)
      if (!child.same(first))
         return false;
   value = first.value();
   return true;
}

/// Makes a node that is empty or of one value a uniform block.
void collapse(Block &slot)
{
   if (!slot.isNode())
      return;
   const Node &node = *slot.node();
   std::uint32_t value = 0;
   if (node.bounds.empty())
      slot = Block();
   else if (node.level == 0 ? asBrick(node).isUniform(value) : isUniform(asInner(node), value))
      slot = Block::uniform(value);
}

Change setWithin(Block &slot, int level, Coord u, Index i, std::uint32_t value)
{
   if (!slot.isNode() && slot.value() == value)
      return {};
   Node &node = writable(slot, level, blockOrigin(u, level));
   if (level == 0) {
      const Change change = static_cast<Brick &>(node).set(brickCell(u), i, value);
      if (change.changed)
         collapse(slot);
      return change;
   }
   auto &inner = static_cast<Inner &>(node);
   Block &child = inner.children[childNumber(u, level)];
   const Change change = setWithin(child, level - 1, u, i, value);
   if (!change.changed)
      return change;
   if (inner.count > ~std::uint64_t{0} / 2)
      summariseCount(inner);
   else
      inner.count += static_cast<std::uint64_t>(static_cast<std::int64_t>(change.added));
   const Box &b = inner.bounds;
   if (change.added > 0)
      inner.bounds.extend(i);
   else if (change.added < 0 && (i.x == b.min.x || i.y == b.min.y || i.z == b.min.z || i.x == b.max.x ||
                                 i.y == b.max.y || i.z == b.max.z))
      summariseBounds(inner, blockOrigin(u, level));
   if (!child.isNode())
      collapse(slot);
   return change;
}

/// New content of the part of a brick that lies in `range`: either one value, or cells in order x, y, z of
/// the range.
struct Content
{
   std::uint32_t value = 0;
   const Cell *cells = nullptr;
};

void overwriteBrick(Block &slot, Coord origin, const Range &range, const Content &content)
{
   std::array<std::uint32_t, kBrickCells> cells;
   if (slot.isNode())
      asBrick(*slot.node()).decode(cells.data());
   else
      cells.fill(slot.value());
   const auto low = [](std::uint32_t o, std::uint32_t from) { return from > o ? from - o : 0; };
   const auto high = [](std::uint32_t o, std::uint32_t to) { return to - o < 15 ? to - o : 15; };
   const std::size_t sizeY = range.high.y - range.low.y + std::size_t{1};
   const std::size_t sizeZ = range.high.z - range.low.z + std::size_t{1};
   const unsigned z0 = low(origin.z, range.low.z), z1 = high(origin.z, range.high.z);
   for (unsigned x = low(origin.x, range.low.x); x <= high(origin.x, range.high.x); ++x)
      for (unsigned y = low(origin.y, range.low.y); y <= high(origin.y, range.high.y); ++y) {
         std::uint32_t *row = &cells[x << 8 | y << 4];
         if (!content.cells) {
            std::fill(row + z0, row + z1 + 1, content.value);
            continue;
         }
         const Cell *from = content.cells +
                            ((origin.x + x - range.low.x) * sizeY + (origin.y + y - range.low.y)) * sizeZ +
                            (origin.z + z0 - range.low.z);
         for (unsigned z = z0; z <= z1; ++z, ++from)
            row[z] = from->empty() ? 0 : from->packed();
      }
   slot = Block::own(new Brick(cells.data(), origin));
}

void overwrite(Block &slot, int level, Coord origin, const Range &range, const Content &content)
{
   if (!content.cells && !slot.isNode() && slot.value() == content.value)
      return;
   if (!content.cells && range.covers(origin, level)) {
      slot = Block::uniform(content.value);
      return;
   }
   if (level == 0) {
      overwriteBrick(slot, origin, range, content);
   } else {
      auto &inner = static_cast<Inner &>(writable(slot, level, origin));
      for (unsigned c = 0; c < 64; ++c) {
         const Coord at = childOrigin(origin, level, c);
         if (range.meets(at, level - 1))
            overwrite(inner.children[c], level - 1, at, range, content);
      }
      summariseCount(inner);
      summariseBounds(inner, origin);
   }
   collapse(slot);
}

void mapWithin(Block &slot, int level, Coord origin, const std::function<std::uint32_t(std::uint32_t)> &map)
{
   if (!slot.isNode()) {
      if (!slot.empty())
         slot = Block::uniform(map(slot.value()));
      return;
   }
   if (level == 0) {
      std::array<std::uint32_t, kBrickCells> cells;
      asBrick(*slot.node()).decode(cells.data());
      bool changed = false;
      for (std::uint32_t &value : cells) {
         const std::uint32_t mapped = value == 0 ? 0 : map(value);
         changed = changed || mapped != value;
         value = mapped;
      }
      if (changed)
         slot = Block::own(new Brick(cells.data(), origin));
   } else {
      // Children are tried on a copy, so that a node without the value stays shared.
      auto children = asInner(*slot.node()).children;
      bool changed = false;
      for (unsigned c = 0; c < 64; ++c) {
         mapWithin(children[c], level - 1, childOrigin(origin, level, c), map);
         changed = changed || !children[c].same(asInner(*slot.node()).children[c]);
      }
      if (!changed)
         return;
      auto &inner = static_cast<Inner &>(writable(slot, level, origin));
      inner.children = std::move(children);
      summariseCount(inner);
      summariseBounds(inner, origin);
   }
   collapse(slot);
}

/// Makes the root's block hold both coordinates and gives its level; the result may be more than canonical.
int growRoot(Block &root, Coord low, Coord high)
{
   int level = 1;
   if (root.empty()) {
      while (!sameBlock(low, high, level))
         ++level;
      return level;
   }
   level = root.node()->level;
   const Coord anchor = biased(root.node()->bounds.min);
   while (!sameBlock(low, anchor, level) || !sameBlock(high, anchor, level)) {
      DIATOM_CHECK(level < kTopLevel);
      auto *inner = new Inner(level + 1);
      inner->count = root.node()->count;
      inner->bounds = root.node()->bounds;
      collapse(root);
      inner->children[childNumber(anchor, level + 1)] = std::move(root);
      root = Block::own(inner);
      ++level;
   }
   return level;
}

/// Back to the smallest inner node that holds everything. `inside` is any coordinate within the root's block.
void settleRoot(Block &root, int level, Coord inside)
{
   if (root.empty())
      return;
   if (!root.isNode())
      root = Block::own(newNode(root.value(), level, blockOrigin(inside, level)));
   for (; level > 1; --level) {
      const Box bounds = root.node()->bounds;
      const Coord low = biased(bounds.min);
      if (!sameBlock(low, biased(bounds.max), level - 1))
         return;
      Block child = asInner(*root.node()).children[childNumber(low, level)];
      if (!child.isNode())
         child = Block::own(newNode(child.value(), level - 1, blockOrigin(low, level - 1)));
      root = std::move(child);
   }
}

/// The usual edit, without recursion: a cell that is not empty, into a brick that this tree owns alone and
/// that cannot become uniform by it. False, with nothing done, when the general way must be taken.
bool setInPlace(Block &root, Coord u, Index i, std::uint32_t value)
{
   std::array<Node *, kTopLevel + 1> path;
   if (root.empty() || !sameBlock(u, biased(root.node()->bounds.min), root.node()->level))
      return false;
   Block *slot = &root;
   int level = root.node()->level;
   for (int n = level;; --n) {
      if (!slot->isNode() || slot->node()->references.load(std::memory_order_acquire) != 1)
         return false;
      path[static_cast<std::size_t>(n)] = slot->mutableNode();
      if (n == 0)
         break;
      slot = &static_cast<Inner *>(slot->mutableNode())->children[childNumber(u, n)];
   }
   auto &brick = static_cast<Brick &>(*path[0]);
   if (brick.count >= kBrickCells - 1)
      return false;
   const Change change = brick.set(brickCell(u), i, value);
   if (!change.changed)
      return true;
   brick.hashed.store(false, std::memory_order_relaxed);
   for (int n = 1; n <= level; ++n) {
      auto &inner = static_cast<Inner &>(*path[static_cast<std::size_t>(n)]);
      inner.hashed.store(false, std::memory_order_relaxed);
      if (inner.count > ~std::uint64_t{0} / 2)
         summariseCount(inner);
      else
         inner.count += static_cast<std::uint64_t>(change.added);
      if (!inner.bounds.contains(i))
         inner.bounds.extend(i);
   }
   return true;
}

} // namespace

void setCell(Block &root, Index i, std::uint32_t value)
{
   const Coord u = biased(i);
   if (value != 0 && setInPlace(root, u, i, value))
      return;
   const bool within = !root.empty() && root.node()->bounds.contains(i);
   if (value == 0 && !within)
      return;
   const int level = growRoot(root, u, u);
   const Change change = setWithin(root, level, u, i, value);
   // Content inside unchanged bounds leaves the root as it is.
   if (change.added < 0 || !root.isNode())
      settleRoot(root, level, u);
}

void fillRange(Block &root, const Range &range, std::uint32_t value)
{
   const int level = growRoot(root, range.low, range.high);
   overwrite(root, level, blockOrigin(range.low, level), range, {value, nullptr});
   settleRoot(root, level, range.low);
}

void writeRange(Block &root, const Range &range, const Cell *cells)
{
   const int level = growRoot(root, range.low, range.high);
   overwrite(root, level, blockOrigin(range.low, level), range, {0, cells});
   settleRoot(root, level, range.low);
}

void mapValues(Block &root, const std::function<std::uint32_t(std::uint32_t)> &map)
{
   if (root.empty())
      return;
   const int level = root.node()->level;
   const Coord inside = biased(root.node()->bounds.min);
   mapWithin(root, level, blockOrigin(inside, level), map);
   settleRoot(root, level, inside);
}

} // namespace diatom::detail
