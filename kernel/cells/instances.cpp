// The sorted set of placements: Morton order of origins, in chunks that stay between half and full.
#include "cells/instances.h"

#include <algorithm>
#include <atomic>
#include <map>

namespace diatom {

namespace {

constexpr std::size_t kChunkLimit = 256;

/// Order along the Morton curve (x before y before z at each bit): decided by the axis whose coordinates
/// differ in the highest bit. T. M. Chan, "Closest-point problems simplified on the RAM", SODA 2002.
bool mortonLess(Index a, Index b)
{
   const auto flipped = [](std::int32_t v) { return static_cast<std::uint32_t>(v) ^ 0x80000000U; };
   const std::uint32_t p[3] = {flipped(a.x), flipped(a.y), flipped(a.z)};
   const std::uint32_t q[3] = {flipped(b.x), flipped(b.y), flipped(b.z)};
   int axis = 0;
   std::uint32_t highest = p[0] ^ q[0];
   for (int k = 1; k < 3; ++k) {
      const std::uint32_t difference = p[k] ^ q[k];
      if (highest < difference && highest < (highest ^ difference)) {
         highest = difference;
         axis = k;
      }
   }
   return p[axis] < q[axis];
}

bool before(const Placement &a, const Placement &b)
{
   if (a.origin != b.origin)
      return mortonLess(a.origin, b.origin);
   return a.definition != b.definition ? a.definition < b.definition : a.rotation < b.rotation;
}

/// The chunk that holds the placement or would take it.
std::size_t chunkFor(std::span<const std::shared_ptr<const Instances::Chunk>> chunks,
                     const Placement &placement)
{
   const auto after =
       std::upper_bound(chunks.begin(), chunks.end(), placement,
                        [](const Placement &p, const auto &c) { return before(p, c->front()); });
   return after == chunks.begin() ? 0 : static_cast<std::size_t>(after - chunks.begin()) - 1;
}

} // namespace

bool Instances::contains(const Placement &placement) const
{
   if (m_count == 0)
      return false;
   const Chunk &chunk = *chunks()[chunkFor(chunks(), placement)];
   return std::binary_search(chunk.begin(), chunk.end(), placement, before);
}

Instances::Chunks &Instances::writable()
{
   if (!m_chunks) {
      m_chunks = std::make_shared<Chunks>();
   } else if (m_chunks.use_count() != 1) {
      m_chunks = std::make_shared<Chunks>(*m_chunks);
   } else {
      // use_count() is a relaxed load: order our writes after the last reads of owners that let go.
      std::atomic_thread_fence(std::memory_order_acquire);
   }
   return *m_chunks;
}

bool Instances::insert(const Placement &placement)
{
   if (contains(placement))
      return false;
   const std::size_t c = m_count == 0 ? 0 : chunkFor(chunks(), placement);
   Chunks &next = writable();
   if (next.empty()) {
      next.push_back(std::make_shared<const Chunk>(Chunk{placement}));
   } else {
      Chunk chunk = *next[c];
      chunk.insert(std::upper_bound(chunk.begin(), chunk.end(), placement, before), placement);
      if (chunk.size() > kChunkLimit) {
         const auto middle = chunk.begin() + kChunkLimit / 2;
         next.insert(next.begin() + static_cast<std::ptrdiff_t>(c) + 1,
                     std::make_shared<const Chunk>(middle, chunk.end()));
         chunk.erase(middle, chunk.end());
      }
      next[c] = std::make_shared<const Chunk>(std::move(chunk));
   }
   ++m_count;
   return true;
}

bool Instances::erase(const Placement &placement)
{
   if (!contains(placement))
      return false;
   --m_count;
   if (m_count == 0) {
      m_chunks.reset();
      return true;
   }
   const std::size_t c = chunkFor(chunks(), placement);
   Chunks &next = writable();
   const auto at = next.begin() + static_cast<std::ptrdiff_t>(c);
   Chunk chunk = **at;
   chunk.erase(std::lower_bound(chunk.begin(), chunk.end(), placement, before));
   // A chunk that has become small joins its successor, so that many erasures do not leave many tiny chunks.
   if (at + 1 != next.end() && chunk.size() + (*(at + 1))->size() <= kChunkLimit / 2) {
      chunk.insert(chunk.end(), (*(at + 1))->begin(), (*(at + 1))->end());
      next.erase(at + 1);
   }
   if (chunk.empty())
      next.erase(next.begin() + static_cast<std::ptrdiff_t>(c));
   else
      next[c] = std::make_shared<const Chunk>(std::move(chunk));
   return true;
}

bool Instances::visit(const std::function<bool(const Placement &)> &visit) const
{
   for (const auto &chunk : chunks())
      for (const Placement &placement : *chunk)
         if (!visit(placement))
            return false;
   return true;
}

std::vector<std::pair<DefinitionId, std::uint64_t>> Instances::countByDefinition() const
{
   std::map<DefinitionId, std::uint64_t> counts;
   for (const auto &chunk : chunks())
      for (const Placement &placement : *chunk)
         ++counts[placement.definition];
   return {counts.begin(), counts.end()};
}

bool operator==(const Instances &a, const Instances &b)
{
   if (a.m_chunks == b.m_chunks)
      return true;
   if (a.m_count != b.m_count)
      return false;
   const auto p = a.chunks(), q = b.chunks();
   std::size_t chunk = 0, within = 0;
   for (const auto &mine : p)
      for (const Placement &placement : *mine) {
         if (within == q[chunk]->size()) {
            ++chunk;
            within = 0;
         }
         if (placement != (*q[chunk])[within++])
            return false;
      }
   return true;
}

void Instances::hash(Hasher &hasher) const
{
   hasher.add(m_count);
   visit([&](const Placement &p) {
      hasher.add(p.definition);
      hasher.add(p.origin.x);
      hasher.add(p.origin.y);
      hasher.add(p.origin.z);
      hasher.add(p.rotation);
      return true;
   });
}

} // namespace diatom
