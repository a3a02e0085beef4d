// DIATOM_CHECK: for bugs only, on in every build. Bad input and failing systems are Results (result.h), never
// checks.
#pragma once

namespace diatom {

[[noreturn]] void checkFailed(const char *condition, const char *file, int line);

} // namespace diatom

#define DIATOM_CHECK(condition)                                                                              \
   ((condition) ? static_cast<void>(0) : ::diatom::checkFailed(#condition, __FILE__, __LINE__))
