#include "core/check.h"

#include <cstdio>
#include <cstdlib>

namespace diatom {

void checkFailed(const char *condition, const char *file, int line)
{
   std::fprintf(stderr, "diatom: internal error: %s does not hold (%s:%d)\n", condition, file, line);
   std::abort();
}

} // namespace diatom
