#include "plugins/process_state.h"

#include <clocale>
#include <filesystem>
#include <system_error>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace diatom {

namespace {

/// Control part of the floating-point mode: loading a library linked with -ffast-math sets flush-to-zero
/// here.
unsigned floatingPointControl()
{
#if defined(__SSE__)
   constexpr unsigned kStickyFlags = 0x3f;
   return _mm_getcsr() & ~kStickyFlags;
#else
   return static_cast<unsigned>(std::fegetround());
#endif
}

std::string workingDirectory()
{
   std::error_code error;
   const auto path = std::filesystem::current_path(error);
   return error ? std::string() : path.string();
}

} // namespace

ProcessState::ProcessState(Depth depth) : m_control(floatingPointControl()), m_environment{}
{
   std::fegetenv(&m_environment);
   if (const char *locale = std::setlocale(LC_ALL, nullptr))
      m_locale = locale;
   if (depth == Depth::thorough)
      m_directory = workingDirectory();
}

std::string ProcessState::restore()
{
   std::string changed;
   const auto add = [&](const char *what) {
      changed += (changed.empty() ? "" : " and ") + std::string(what);
   };
   if (floatingPointControl() != m_control) {
      std::fesetenv(&m_environment);
      add("the floating-point mode");
   }
   const char *locale = std::setlocale(LC_ALL, nullptr);
   if (locale && m_locale != locale) {
      std::setlocale(LC_ALL, m_locale.c_str());
      add("the locale");
   }
   if (!m_directory.empty() && workingDirectory() != m_directory) {
      std::error_code gone; // the folder may be deleted: nothing to go back to
      std::filesystem::current_path(m_directory, gone);
      add("the working directory");
   }
   return changed;
}

} // namespace diatom
