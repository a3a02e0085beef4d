// Which rule is broken: the environment says, so that one plugin shows that each check can fail.
#pragma once

#include <diatom/plugin.hpp>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <string_view>
#include <thread>

namespace unruly {

inline bool breaks(std::string_view rule)
{
   const char *fault = std::getenv("DIATOM_TEST_FAULT");
   return fault && rule == fault;
}

inline void sleep(int milliseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds)); }

/// Longer than a rule allows, in a build that is allowed more time too.
inline void oversleep(int milliseconds)
{
   const char *slowdown = std::getenv("DIATOM_TEST_SLOWDOWN");
   sleep(milliseconds * (slowdown ? std::atoi(slowdown) : 1));
}

/// 0 where the rules of `kind` are kept; else what makes answers differ that must not: a count of calls, or
/// how many calls run at once.
inline double wobble(std::string_view kind)
{
   static std::atomic<int> calls{0}, running{0};
   const std::string rule(kind);
   if (breaks(rule + ".repeats"))
      return 1e-3 * ++calls;
   if (!breaks(rule + ".threads"))
      return 0;
   const int others = running++;
   sleep(5);
   --running;
   return 1e-3 * others;
}

/// Writes where it was not looked whether there is memory. Sanitizers let the processor find it.
__attribute__((no_sanitize("undefined"))) inline void writeTo(void *memory)
{
   *static_cast<volatile char *>(memory) = 1;
}

/// What create() of every kind does before its work.
inline void begin(std::string_view kind, const diatom_call *call, const diatom_create *create)
{
   using diatom::sdk::Failure;
   const std::string rule(kind);
   if (std::string_view(create->id) != "test.unruly." + rule && !breaks("module.ids"))
      throw Failure(DIATOM_BAD_INPUT, "there is no such thing here");
   if (breaks(rule + ".records") && create->size != sizeof(diatom_create))
      throw Failure(DIATOM_BAD_INPUT, "the record has another size");
   if (breaks(rule + ".scratch"))
      writeTo(call->scratch(call, 64));
   if (breaks(rule + ".life"))
      static_cast<char *>(std::malloc(64))[0] = static_cast<char>(rule.size()); // never freed
   if (breaks(rule + ".prints"))
      std::puts("made one");
   if (breaks(rule + ".exits"))
      std::exit(0);
}

} // namespace unruly
