// What a plugin did that it must not, and what it warns of itself, told while the work goes on.
#pragma once

#include <functional>
#include <string>

namespace diatom {

enum class PluginWarning {
   misdeed, // the contract was broken
   remark   // the plugin's own, in a call that succeeded: what it says of its result
};

/// Tells a sentence once in a process. Any thread.
void warnOfPlugin(const std::string &sentence, PluginWarning kind = PluginWarning::misdeed);

/// Where sentences go; standard error without. May be called from any thread, one call at a time.
using PluginWarnings = std::function<void(const std::string &sentence, PluginWarning kind)>;
void setPluginWarnings(PluginWarnings to);

/// While one lives, remarks of calls that its own thread makes are not told: for runs that compare, whose
/// results nobody is to trust. Those of a run in another thread are.
class RemarksMuted
{
public:
   RemarksMuted();
   ~RemarksMuted();
   RemarksMuted(const RemarksMuted &) = delete;
   RemarksMuted &operator=(const RemarksMuted &) = delete;
};

} // namespace diatom
