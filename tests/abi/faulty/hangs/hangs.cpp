// Is never done with being loaded.
#include <diatom/abi/lattice.h>
#include <diatom/plugin.hpp>

#include <unistd.h>

namespace {

[[gnu::constructor]] void hang()
{
   for (;;)
      pause();
}

std::int32_t create(const diatom_call *, const diatom_create *, void **) { return DIATOM_UNSUPPORTED; }
std::int32_t motif(void *, const diatom_call *, const diatom_motif **) { return DIATOM_UNSUPPORTED; }
void destroy(void *) {}

const diatom_lattice kTable{create, motif, destroy};

const void *get(const char *) { return &kTable; }

} // namespace

DIATOM_MODULE(get)
