// Whole files in, and files out that are either complete or not there: a crash or a full disk leaves the old
// one.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace diatom {

/// The file's bytes; `-` reads standard input. Refuses files above `limit` bytes before reading them.
Result<std::string> readFile(const std::filesystem::path &path, std::uint64_t limit = std::uint64_t{4} << 30);

/// Writes beside the target and renames on commit(). Without commit() the temporary file is removed and the
/// target is as it was. Errors are kept: write() after a failure does nothing, commit() reports the first
/// one. Not copyable; one thread. The path `-` writes to standard output.
class AtomicFile
{
public:
   explicit AtomicFile(std::filesystem::path target);
   ~AtomicFile();
   AtomicFile(const AtomicFile &) = delete;
   AtomicFile &operator=(const AtomicFile &) = delete;

   void write(std::string_view bytes);
   /// Overwrites bytes already written, for counts that are known only at the end. Not for standard output.
   void writeAt(std::uint64_t offset, std::string_view bytes);
   std::uint64_t written() const { return m_written; }
   bool failed() const { return !m_error.empty(); }
   /// Flushes to the disk and puts the file in place.
   Status commit();

private:
   void put(const char *data, std::size_t count);
   void flush();
   void fail(const char *doing);

   std::filesystem::path m_target, m_temporary;
   int m_descriptor = -1;
   bool m_toOutput = false;
   std::uint64_t m_written = 0;
   std::string m_buffer, m_error;
};

/// Makes the folder and those above it where they are not there.
Status makeFolder(const std::filesystem::path &folder);

Status writeFileAtomic(const std::filesystem::path &path, std::string_view bytes);

} // namespace diatom
