// A sparse array of cells over all of index space: a tree of 16^3 bricks, copy-on-write, cheap to keep every
// version of.
#pragma once

#include "cells/block.h"
#include "cells/cell.h"
#include "core/hash.h"
#include "core/index.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace diatom {

namespace detail {
struct Brick;
}

/// A value: copying costs a pointer, copies share everything until one of them changes. Different copies may
/// be used from different threads; one object from one thread at a time (const calls from many).
class CellArray
{
public:
   Cell at(Index i) const;
   bool empty() const;
   /// Cells that are not empty; stays at 2^64 - 1 beyond.
   std::uint64_t count() const;
   /// Tight: grows and shrinks with the content.
   Box bounds() const;
   /// Cells per material, indexed by material; element 0 is 0.
   std::vector<std::uint64_t> countByMaterial() const;

   /// Out of range (core/index.h) does nothing. Setting an empty cell erases.
   void set(Index i, Cell cell);
   /// Sets every cell of the box; whole bricks and larger blocks are stored as one value,
   /// so time and memory grow with the surface of the box, not with its volume.
   void fill(const Box &box, Cell cell);
   /// Sets every cell of the box, which must be in range, from as many cells in order x, y, z (z fastest):
   /// the quick way in for importers, several times faster than one by one.
   void write(const Box &box, std::span<const Cell> cells);
   void clear();
   /// Replaces a material everywhere.
   void replaceMaterial(MaterialIndex from, MaterialIndex to);

   /// Calls visit(index, cell) for every cell within `box`, in order of (x, y, z) blocks that depends on
   /// content only. Stops when visit returns false; returns whether it ran to the end.
   bool visit(const Box &box, const std::function<bool(Index, Cell)> &visit) const;
   bool visit(const std::function<bool(Index, Cell)> &visit) const;
   /// Calls visit(box, cell) for maximal stored blocks of one value: uniform regions are not expanded.
   void visitBlocks(const Box &box, const std::function<bool(const Box &, Cell)> &visit) const;

   /// Equal content, however it came about. Shared parts compare at once.
   friend bool operator==(const CellArray &a, const CellArray &b);
   /// Feeds the content in an order that depends on content only.
   void hash(Hasher &hasher) const;
   /// Bytes held, shared ones counted fully.
   std::uint64_t bytes() const;
   /// The tree itself, for the kernel's own queries (cells/tree.h).
   const detail::Block &root() const { return m_root; }

   /// Fast repeated access near one place: keeps the last brick. Valid while the array is not changed.
   class Reader
   {
   public:
      explicit Reader(const CellArray &array) : m_array(&array) {}
      Cell at(Index i);

   private:
      const CellArray *m_array;
      const detail::Brick *m_brick = nullptr; // null: m_value everywhere in the block
      std::uint32_t m_value = 0;
      int m_level = 0;
      Index m_inside; // any index of the block
      bool m_known = false;
   };

private:
   detail::Block m_root; // an inner node of the tree, or empty
};

} // namespace diatom
