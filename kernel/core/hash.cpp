#include "core/hash.h"

#include <fmt/format.h>
#include <xxhash.h>

namespace diatom {

std::string Hash::text() const { return fmt::format("{:016x}{:016x}", high, low); }

Hasher::Hasher() : m_state(XXH3_createState()) { XXH3_128bits_reset(m_state); }

Hasher::~Hasher() { XXH3_freeState(m_state); }

void Hasher::bytes(const void *data, std::size_t count)
{
   if (count > 0)
      XXH3_128bits_update(m_state, data, count);
}

Hash Hasher::finish() const
{
   const XXH128_hash_t digest = XXH3_128bits_digest(m_state);
   return {digest.high64, digest.low64};
}

} // namespace diatom
