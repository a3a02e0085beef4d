#include "plugins/process_traces.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

namespace diatom {

namespace {

std::int64_t entries(const char *folder)
{
   namespace fs = std::filesystem;
   std::error_code error;
   std::int64_t count = 0;
   for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
      ++count;
   return count;
}

mode_t fileMask()
{
   const mode_t mask = umask(0); // the only way to read it
   umask(mask);
   return mask;
}

std::string environmentText()
{
   std::string text;
   for (char **variable = environ; variable && *variable; ++variable)
      text.append(*variable).push_back('\0');
   return text;
}

} // namespace

ProcessTraces::ProcessTraces()
    : m_threads(entries("/proc/self/task")), m_descriptors(entries("/proc/self/fd")), m_mask(fileMask()),
      m_environment(environmentText())
{
   for (std::size_t i = 0; i < kCrashSignals.size(); ++i) {
      struct sigaction action = {};
      sigaction(kCrashSignals[i], nullptr, &action);
      m_handled[i] = action.sa_handler != SIG_DFL;
   }
}

std::string ProcessTraces::since(const ProcessTraces &before) const
{
   std::string text;
   const auto add = [&](bool is, const char *what) {
      if (is)
         text += std::string(text.empty() ? "" : " and ") + what;
   };
   add(m_threads > before.m_threads, "leaves threads running");
   add(m_descriptors > before.m_descriptors, "leaves files open");
   add(m_handled != before.m_handled, "catches the signals of crashes");
   add(m_mask != before.m_mask, "changes the permissions of new files");
   add(m_environment != before.m_environment, "changes the environment");
   return text;
}

} // namespace diatom
