// What a plugin must leave alone in the process, saved before and put back after its code has run.
#pragma once

#include <cfenv>
#include <string>

namespace diatom {

/// Saves the floating-point mode and the locale. restore() puts back what changed and says what that was.
class ProcessState
{
public:
   ProcessState();
   /// "", or what had been changed: "floating-point mode", "locale".
   std::string restore();

private:
   unsigned m_control; // rounding, flush-to-zero and masks, without the sticky exception flags
   std::fenv_t m_environment;
   std::string m_locale;
};

} // namespace diatom
