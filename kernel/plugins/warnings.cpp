#include "plugins/warnings.h"

#include <cstdio>
#include <mutex>
#include <set>

namespace diatom {

namespace {

struct Warned
{
   std::mutex mutex;
   std::set<std::string> told;
   PluginWarnings to;
};

Warned &warned()
{
   static auto *const only = new Warned; // a plugin's thread may warn while the process ends
   return *only;
}

} // namespace

void warnOfPlugin(const std::string &sentence)
{
   Warned &self = warned();
   const std::lock_guard lock(self.mutex);
   if (!self.told.insert(sentence).second)
      return;
   if (self.to)
      self.to(sentence);
   else
      std::fprintf(stderr, "%s\n", sentence.c_str());
}

void setPluginWarnings(PluginWarnings to)
{
   Warned &self = warned();
   const std::lock_guard lock(self.mutex);
   self.to = std::move(to);
   self.told.clear();
}

} // namespace diatom
