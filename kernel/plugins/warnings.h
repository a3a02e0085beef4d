// What a plugin did that it must not, told while the work goes on.
#pragma once

#include <functional>
#include <string>

namespace diatom {

/// Tells a sentence once in a process. Any thread.
void warnOfPlugin(const std::string &sentence);

/// Where sentences go; standard error without. May be called from any thread, one call at a time.
using PluginWarnings = std::function<void(const std::string &sentence)>;
void setPluginWarnings(PluginWarnings to);

} // namespace diatom
