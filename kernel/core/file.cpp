#include "core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace diatom {

namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

Error unreadable(const std::filesystem::path &path, std::string_view why)
{
   return {ErrorCode::unreadable, fmt::format("{}: cannot be read: {}", path.string(), why)};
}

Result<std::string> readDescriptor(int descriptor, const std::filesystem::path &path, std::uint64_t limit)
{
   std::string bytes;
   char block[1 << 16];
   for (;;) {
      const ssize_t got = ::read(descriptor, block, sizeof block);
      if (got < 0 && errno == EINTR)
         continue;
      if (got < 0)
         return unreadable(path, std::strerror(errno));
      if (got == 0)
         return bytes;
      bytes.append(block, static_cast<std::size_t>(got));
      if (bytes.size() > limit)
         return unreadable(path, fmt::format("it is larger than the {} bytes such a file may have", limit));
   }
}

} // namespace

Result<std::string> readFile(const std::filesystem::path &path, std::uint64_t limit)
{
   if (path == "-")
      return readDescriptor(STDIN_FILENO, "standard input", limit);
   const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
   if (descriptor < 0)
      return unreadable(path, std::strerror(errno));
   struct stat info = {};
   if (::fstat(descriptor, &info) == 0 && S_ISDIR(info.st_mode)) {
      ::close(descriptor);
      return unreadable(path, "it is a folder");
   }
   if (S_ISREG(info.st_mode) && static_cast<std::uint64_t>(info.st_size) > limit) {
      ::close(descriptor);
      return unreadable(path, fmt::format("it is larger than the {} bytes such a file may have", limit));
   }
   auto bytes = readDescriptor(descriptor, path, limit);
   ::close(descriptor);
   return bytes;
}

AtomicFile::AtomicFile(std::filesystem::path target)
    : m_target(std::move(target)), m_toOutput(m_target == "-")
{
   if (m_toOutput) {
      m_descriptor = STDOUT_FILENO;
      return;
   }
   // Through a link to the file it names, so that saving does not replace the link.
   std::error_code ignored;
   if (std::filesystem::is_symlink(m_target, ignored))
      m_target = std::filesystem::weakly_canonical(m_target, ignored);
   const auto folder = m_target.has_parent_path() ? m_target.parent_path() : std::filesystem::path(".");
   std::string name = (folder / ("." + m_target.filename().string() + ".XXXXXX")).string();
   m_descriptor = ::mkostemp(name.data(), O_CLOEXEC);
   if (m_descriptor < 0) {
      fail("created");
      return;
   }
   m_temporary = name;
   struct stat info = {};
   const mode_t mask = ::umask(0);
   ::umask(mask);
   const mode_t mode = ::stat(m_target.c_str(), &info) == 0 ? (info.st_mode & 0777) : (0666 & ~mask);
   if (::fchmod(m_descriptor, mode) != 0)
      fail("created");
}

AtomicFile::~AtomicFile()
{
   if (m_toOutput)
      return;
   if (m_descriptor >= 0)
      ::close(m_descriptor);
   if (!m_temporary.empty())
      ::unlink(m_temporary.c_str());
}

void AtomicFile::fail(const char *doing)
{
   if (m_error.empty())
      m_error = fmt::format("{}: cannot be {}: {}; the old file, if any, is as it was", m_target.string(),
                            doing, std::strerror(errno));
}

void AtomicFile::put(const char *data, std::size_t count)
{
   while (count > 0 && m_error.empty()) {
      const ssize_t done = ::write(m_descriptor, data, count);
      if (done < 0 && errno == EINTR)
         continue;
      if (done < 0) {
         fail("written");
         return;
      }
      data += done;
      count -= static_cast<std::size_t>(done);
   }
}

void AtomicFile::flush()
{
   put(m_buffer.data(), m_buffer.size());
   m_buffer.clear();
}

void AtomicFile::write(std::string_view bytes)
{
   m_written += bytes.size();
   m_buffer.append(bytes);
   if (m_buffer.size() >= kBufferBytes)
      flush();
}

void AtomicFile::writeAt(std::uint64_t offset, std::string_view bytes)
{
   flush();
   if (m_error.empty() && ::pwrite(m_descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset)) !=
                              static_cast<ssize_t>(bytes.size()))
      fail("written");
}

Status AtomicFile::commit()
{
   flush();
   if (m_error.empty() && !m_toOutput) {
      if (::fsync(m_descriptor) != 0)
         fail("written to the disk");
      ::close(m_descriptor);
      m_descriptor = -1;
      if (m_error.empty() && ::rename(m_temporary.c_str(), m_target.c_str()) != 0)
         fail("put in place");
      else if (m_error.empty())
         m_temporary.clear();
   }
   if (!m_error.empty())
      return Error{ErrorCode::unwritable, m_error};
   return {};
}

Status makeFolder(const std::filesystem::path &folder)
{
   std::error_code failed;
   std::filesystem::create_directories(folder, failed);
   if (failed)
      return Error{ErrorCode::unwritable,
                   fmt::format("the folder {} cannot be made: {}", folder.string(), failed.message())};
   return {};
}

Status writeFileAtomic(const std::filesystem::path &path, std::string_view bytes)
{
   AtomicFile file(path);
   file.write(bytes);
   return file.commit();
}

} // namespace diatom
