// What a plugin may leave behind in a process and must not: threads, open files, signal handlers and the
// like.
#pragma once

#include <sys/types.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <string>

namespace diatom {

inline constexpr std::array kCrashSignals{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

/// The process as it is where this is made. Looks only; what is to be put back is ProcessState's.
class ProcessTraces
{
public:
   ProcessTraces();
   /// "", or what is there that was not: "leaves threads running and leaves files open".
   std::string since(const ProcessTraces &before) const;

private:
   std::int64_t m_threads, m_descriptors;
   std::array<bool, kCrashSignals.size()> m_handled{};
   mode_t m_mask;
   std::string m_environment;
};

} // namespace diatom
