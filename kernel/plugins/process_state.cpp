#include "plugins/process_state.h"

#include <clocale>

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

} // namespace

ProcessState::ProcessState() : m_control(floatingPointControl()), m_environment{}
{
   std::fegetenv(&m_environment);
   if (const char *locale = std::setlocale(LC_ALL, nullptr))
      m_locale = locale;
}

std::string ProcessState::restore()
{
   std::string changed;
   if (floatingPointControl() != m_control) {
      std::fesetenv(&m_environment);
      changed = "floating-point mode";
   }
   const char *locale = std::setlocale(LC_ALL, nullptr);
   if (locale && m_locale != locale) {
      std::setlocale(LC_ALL, m_locale.c_str());
      changed += changed.empty() ? "locale" : " and locale";
   }
   return changed;
}

} // namespace diatom
