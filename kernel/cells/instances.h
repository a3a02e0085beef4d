// Instances of composites in a body: a sorted, chunked, copy-on-write set, so that one edit copies one chunk.
#pragma once

#include "core/hash.h"
#include "core/index.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace diatom {

/// Number of a definition in its model; stable for the life of the document.
using DefinitionId = std::uint32_t;

/// A definition placed with its index (0,0,0) at `origin`, turned by a rotation number of the lattice.
struct Placement
{
   DefinitionId definition = 0;
   Index origin;
   std::uint8_t rotation = 0;
   friend constexpr bool operator==(const Placement &, const Placement &) = default;
   friend constexpr auto operator<=>(const Placement &, const Placement &) = default;
};

/// A value like CellArray. The same placement is held at most once. Ordered along a space-filling curve by
/// origin, so that chunks are compact.
class Instances
{
public:
   std::uint64_t count() const { return m_count; }
   bool contains(const Placement &placement) const;
   /// False when it was there already.
   bool insert(const Placement &placement);
   bool erase(const Placement &placement);
   /// In a fixed order that depends on content only; stops when visit returns false.
   bool visit(const std::function<bool(const Placement &)> &visit) const;
   /// Instances per definition, ordered by id.
   std::vector<std::pair<DefinitionId, std::uint64_t>> countByDefinition() const;
   friend bool operator==(const Instances &a, const Instances &b);
   void hash(Hasher &hasher) const;

   /// Chunks of neighbouring placements, for spatial queries that keep bounds per chunk. Immutable and
   /// shared.
   using Chunk = std::vector<Placement>;
   std::span<const std::shared_ptr<const Chunk>> chunks() const
   {
      return m_chunks ? std::span(*m_chunks) : std::span<const std::shared_ptr<const Chunk>>();
   }

private:
   using Chunks = std::vector<std::shared_ptr<const Chunk>>;
   Chunks &writable();

   std::shared_ptr<Chunks> m_chunks; // never changed while shared; no empty chunk; null = no instances
   std::uint64_t m_count = 0;
};

} // namespace diatom
