// Breaks the plugin contract on purpose, one way per id: what the host's guard is tested with.
#include <diatom/abi/lattice.h>
#include <diatom/plugin.hpp>

#include <clocale>
#include <cstring>
#include <xmmintrin.h>

namespace {

int something = 0;

std::int32_t echo(const diatom_call *call, const diatom_create *create)
{
   const diatom::sdk::Values values(create->values);
   call->report(call, DIATOM_ERROR,
                (std::to_string(values.number("height")) + " " + std::to_string(values.number("count")) +
                 " " + std::string(values.text("mode")))
                    .c_str());
   return DIATOM_BAD_INPUT;
}

std::int32_t create(const diatom_call *call, const diatom_create *create, void **self)
{
   const auto is = [&](const char *id) { return std::strcmp(create->id, id) == 0; };
   *self = &something;
   if (is("test.throws"))
      throw std::runtime_error("out of here");
   if (is("test.refuses")) {
      call->report(call, DIATOM_ERROR, "the moon is not full");
      return DIATOM_BAD_INPUT;
   }
   if (is("test.makes_nothing"))
      *self = nullptr;
   if (is("test.unknown_status"))
      return 4711;
   if (is("test.flushes"))
      _mm_setcsr(_mm_getcsr() | 0x8040); // flush to zero, denormals are zero
   if (is("test.locale"))
      std::setlocale(LC_ALL, "C.UTF-8");
   if (is("test.echo"))
      return echo(call, create);
   return DIATOM_OK;
}

std::int32_t motif(void *, const diatom_call *, const diatom_motif **) { return DIATOM_INTERNAL; }
void destroy(void *) {}

const diatom_lattice table{create, motif, destroy};

const void *get(const char *interface)
{
   return std::strcmp(interface, DIATOM_LATTICE_1) == 0 ? &table : nullptr;
}

} // namespace

DIATOM_MODULE(get)
