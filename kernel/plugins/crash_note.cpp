#include "plugins/crash_note.h"

#include "core/file.h"
#include "core/user_folders.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <mutex>
#include <sstream>

namespace diatom {

namespace {

constexpr std::array kCrashes{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

thread_local const char *calledWho = nullptr;
thread_local const char *calledFunction = nullptr;

/// What the handler needs, made ready beforehand: in it almost nothing may be called.
std::array<char, 4096> notePath{};
std::array<struct sigaction, kCrashes.size()> earlier{};

std::filesystem::path noteFile()
{
   const std::filesystem::path folder = userCacheFolder();
   return folder.empty() ? folder : folder / "plugin_crash";
}

void put(int file, const char *text)
{
   [[maybe_unused]] const ssize_t written = write(file, text, std::strlen(text));
}

/// Writes the note and lets the crash take its course: the instruction is met again, with the earlier
/// handler.
void onCrash(int signal, siginfo_t *info, void *)
{
   for (std::size_t i = 0; i < kCrashes.size(); ++i)
      if (kCrashes[i] == signal)
         sigaction(signal, &earlier[i], nullptr);
   if (calledWho) {
      const int file = open(notePath.data(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
      if (file >= 0) {
         put(file, calledWho);
         put(file, "\t");
         put(file, calledFunction);
         put(file, "\n");
         close(file);
      }
   }
   if (info->si_code <= 0) // sent by a process, as abort() does: it does not come again by itself
      raise(signal);
}

} // namespace

CallNote::CallNote(const char *who, const char *function) : m_who(calledWho), m_function(calledFunction)
{
   calledWho = who;
   calledFunction = function;
}

CallNote::~CallNote()
{
   calledWho = m_who;
   calledFunction = m_function;
}

void leaveNotesOfCrashes()
{
   static std::mutex mutex;
   const std::lock_guard lock(mutex);
   const std::string path = noteFile().string();
   if (path.empty() || path.size() >= notePath.size() || !makeFolder(noteFile().parent_path()).ok())
      return;
   std::memcpy(notePath.data(), path.c_str(), path.size() + 1);
   struct sigaction action = {};
   action.sa_sigaction = onCrash;
   action.sa_flags =
       SA_SIGINFO | SA_ONSTACK; // where the program has a stack for it, also an overflow is noted
   for (std::size_t i = 0; i < kCrashes.size(); ++i) {
      struct sigaction present = {};
      sigaction(kCrashes[i], nullptr, &present);
      if (present.sa_sigaction == onCrash)
         continue;
      earlier[i] = present;
      sigaction(kCrashes[i], &action, nullptr);
   }
}

std::vector<CrashNote> takeCrashNotes()
{
   std::error_code ignored;
   const std::filesystem::path file = noteFile();
   if (file.empty() || !std::filesystem::exists(file, ignored))
      return {};
   constexpr std::uint64_t kLimit = 1 << 20;
   const auto bytes = readFile(file, kLimit);
   std::filesystem::remove(file, ignored);
   std::vector<CrashNote> notes;
   std::istringstream lines(bytes.ok() ? *bytes : std::string());
   for (std::string line; std::getline(lines, line);)
      if (const std::size_t tab = line.find('\t'); tab != std::string::npos)
         notes.push_back({line.substr(0, tab), line.substr(tab + 1)});
   return notes;
}

} // namespace diatom
