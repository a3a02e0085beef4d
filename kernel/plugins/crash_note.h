// Who was being called when the program crashed, so that the next start does not run into it again.
#pragma once

#include <string>
#include <vector>

namespace diatom {

/// Says that this thread is inside a plugin, as long as it lives. Costs two stores.
class CallNote
{
public:
   CallNote(const char *who, const char *function);
   ~CallNote();
   CallNote(const CallNote &) = delete;
   CallNote &operator=(const CallNote &) = delete;

private:
   const char *m_who, *m_function; // of the call around this one
};

/// From now on a crash inside a plugin leaves a note in the user's cache folder before it takes its course.
/// Once a process; called before the first library from outside the installation is loaded.
void leaveNotesOfCrashes();

struct CrashNote
{
   std::string who, function; // the plugin's thing, and the entry of its table
};

/// What earlier crashes left, each told once.
std::vector<CrashNote> takeCrashNotes();

} // namespace diatom
