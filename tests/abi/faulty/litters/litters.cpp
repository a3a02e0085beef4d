// Leaves things behind in the process, one way per id.
#include <diatom/abi/lattice.h>
#include <diatom/plugin.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <thread>

namespace {

int something = 0;

std::int32_t create(const diatom_call *, const diatom_create *create, void **self)
{
   const auto is = [&](const char *id) { return std::strcmp(create->id, id) == 0; };
   *self = &something;
   if (is("test.litters.thread"))
      std::thread([] { pause(); }).detach();
   if (is("test.litters.file") && open("/dev/null", O_RDONLY) < 0)
      return DIATOM_INTERNAL;
   if (is("test.litters.directory") && chdir("/") != 0)
      return DIATOM_INTERNAL;
   if (is("test.litters.signal"))
      std::signal(SIGFPE, SIG_IGN);
   return DIATOM_OK;
}

std::int32_t motif(void *, const diatom_call *, const diatom_motif **) { return DIATOM_UNSUPPORTED; }
void destroy(void *) {}

const diatom_lattice kTable{create, motif, destroy};

const void *get(const char *interface)
{
   return std::strcmp(interface, DIATOM_LATTICE_1) == 0 ? &kTable : nullptr;
}

} // namespace

DIATOM_MODULE(get)
