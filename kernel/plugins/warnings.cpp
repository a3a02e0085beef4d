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

thread_local int muted = 0;

Warned &warned()
{
   static auto *const only = new Warned; // a plugin's thread may warn while the process ends
   return *only;
}

} // namespace

void warnOfPlugin(const std::string &sentence, PluginWarning kind)
{
   Warned &self = warned();
   if (kind == PluginWarning::remark && muted > 0)
      return;
   const std::lock_guard lock(self.mutex);
   if (!self.told.insert(sentence).second)
      return;
   if (self.to)
      self.to(sentence, kind);
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

RemarksMuted::RemarksMuted() { ++muted; }
RemarksMuted::~RemarksMuted() { --muted; }

} // namespace diatom
