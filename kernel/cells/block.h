// An owning reference to part of a cell array's tree: nothing, one value for the whole block, or a shared
// node.
#pragma once

#include <cstdint>
#include <utility>

namespace diatom::detail {

struct Node;

/// Eight bytes, counted by the node itself: a tree of millions of blocks stays small, and asking "am I the
/// only owner" synchronises with other threads' releases, which std::shared_ptr::use_count() does not.
class Block
{
public:
   Block() = default;
   Block(const Block &other) : m_word(other.m_word) { retain(); }
   Block(Block &&other) noexcept : m_word(std::exchange(other.m_word, 0)) {}
   Block &operator=(const Block &other)
   {
      Block copy(other);
      std::swap(m_word, copy.m_word);
      return *this;
   }
   Block &operator=(Block &&other) noexcept
   {
      std::swap(m_word, other.m_word);
      return *this;
   }
   ~Block() { release(); }

   /// A block filled with one packed cell; 0 gives the empty block.
   static Block uniform(std::uint32_t value)
   {
      Block block;
      block.m_word = value == 0 ? 0 : (std::uint64_t{value} << 32) | 1;
      return block;
   }
   /// Takes over the reference that a new node is born with.
   static Block own(Node *node)
   {
      Block block;
      block.m_word = reinterpret_cast<std::uintptr_t>(node);
      return block;
   }

   bool empty() const { return m_word == 0; }
   bool isNode() const { return m_word != 0 && (m_word & 1) == 0; }
   /// The packed cell of a block that is not a node.
   std::uint32_t value() const { return static_cast<std::uint32_t>(m_word >> 32); }
   // A pointer and a packed cell share one word, which halves a node: the cast back is the point.
   // NOLINTBEGIN(performance-no-int-to-ptr)
   const Node *node() const { return reinterpret_cast<const Node *>(static_cast<std::uintptr_t>(m_word)); }
   /// For the only owner.
   Node *mutableNode() { return reinterpret_cast<Node *>(static_cast<std::uintptr_t>(m_word)); }
   // NOLINTEND(performance-no-int-to-ptr)
   /// Same node or same value: equal content without looking.
   bool same(const Block &other) const { return m_word == other.m_word; }

private:
   void retain() const
   {
      if (isNode())
         retainNode();
   }
   void release()
   {
      if (isNode())
         releaseNode();
   }
   void retainNode() const;
   void releaseNode();

   std::uint64_t m_word = 0; // 0, value << 32 | 1, or the node's address
};

} // namespace diatom::detail
