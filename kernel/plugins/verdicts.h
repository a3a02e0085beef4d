// What is known about plugin libraries from outside the installation: the hash of each, and how it stood its
// trial.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace diatom {

/// How a library stood its trial.
struct TrialFinding
{
   bool refused = false; // it is not loaded until its file changes or it is tried again
   std::string text;     // why, or what it did that it must not; "" = nothing
};

/// A cache in the user's cache folder, by path, size, time and hash of the file. What cannot be written is
/// found anew the next time. One thread.
class Verdicts
{
public:
   Verdicts();

   /// SHA-256 of the library; read from the file only when its size or time is not as remembered.
   Result<std::string> hash(const std::filesystem::path &library);
   /// Nothing when this very content has not been tried.
   std::optional<TrialFinding> finding(const std::filesystem::path &library);
   void remember(const std::filesystem::path &library, const TrialFinding &finding);
   void forget(const std::filesystem::path &library);
   /// Writes what has been learnt since, if anything.
   void save();

private:
   struct Entry
   {
      std::uint64_t size = 0;
      std::int64_t time = 0;
      std::string hash;
      std::optional<TrialFinding> finding;
   };
   /// The entry as the file is now; null when it cannot be read.
   Entry *current(const std::filesystem::path &library);

   static std::map<std::string, Entry> load();
   std::map<std::string, Entry> m_entries;
   std::map<std::string, bool> m_changed;
};

/// SHA-256 of a library as it is now.
Result<std::string> libraryHash(const std::filesystem::path &library);

} // namespace diatom
