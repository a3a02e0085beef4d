// Asks for ever more memory while it is loaded. It uses none of it and stops at 16 GiB, for the sake of a
// host that does not stop it.
#include <diatom/abi/lattice.h>
#include <diatom/plugin.hpp>

#include <vector>

namespace {

[[gnu::constructor]] void eat()
{
   constexpr std::size_t kPiece = std::size_t{256} << 20, kPieces = 64;
   static std::vector<void *> eaten;
   while (eaten.size() < kPieces)
      eaten.push_back(::operator new(kPiece));
}

std::int32_t create(const diatom_call *, const diatom_create *, void **) { return DIATOM_UNSUPPORTED; }
std::int32_t motif(void *, const diatom_call *, const diatom_motif **) { return DIATOM_UNSUPPORTED; }
void destroy(void *) {}

const diatom_lattice kTable{create, motif, destroy};

const void *get(const char *) { return &kTable; }

} // namespace

DIATOM_MODULE(get)
