// What a plugin must leave alone in the process, saved before and put back after its code has run.
#pragma once

#include <cfenv>
#include <string>

namespace diatom {

/// Saves the floating-point mode and the locale, and where there is time for it the working directory (a call
/// into the system, too slow for calls made thousands of times a second). restore() puts back what changed
/// and says what that was.
class ProcessState
{
public:
   enum class Depth { quick, thorough };
   explicit ProcessState(Depth depth = Depth::thorough);
   /// "", or what had been changed: "the floating-point mode", "the locale", "the working directory".
   std::string restore();

private:
   unsigned m_control; // rounding, flush-to-zero and masks, without the sticky exception flags
   std::fenv_t m_environment;
   std::string m_locale;
   std::string m_directory; // "" = not looked at
};

} // namespace diatom
