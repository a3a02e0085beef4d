#include "core/archive.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <memory>

namespace diatom {

namespace {

// 1 January 1980, 0:00, the first date a zip can hold.
constexpr zip_uint16_t kDosTime = 0, kDosDate = (1 << 5) | 1;

struct Discard
{
   void operator()(zip_t *archive) const { zip_discard(archive); }
};
struct Free
{
   void operator()(zip_source_t *source) const { zip_source_free(source); }
};
using Archive = std::unique_ptr<zip_t, Discard>;
using Source = std::unique_ptr<zip_source_t, Free>;

/// Reads all of a source that is not open.
Result<std::string> drain(zip_source_t *source)
{
   const auto failed = [source] {
      return Error{ErrorCode::internal,
                   fmt::format("packing failed: {}", zip_error_strerror(zip_source_error(source)))};
   };
   zip_stat_t info;
   if (zip_source_stat(source, &info) != 0 || zip_source_open(source) != 0)
      return failed();
   std::string bytes(info.size, '\0');
   const auto got = zip_source_read(source, bytes.data(), bytes.size());
   zip_source_close(source);
   if (got != static_cast<zip_int64_t>(bytes.size()))
      return failed();
   return bytes;
}

Status addEntry(zip_t *archive, const std::string &name, const std::string &content)
{
   const auto failed = [archive] {
      return Error{ErrorCode::internal, fmt::format("packing failed: {}", zip_strerror(archive))};
   };
   zip_source_t *data = zip_source_buffer(archive, content.data(), content.size(), 0);
   if (!data)
      return failed();
   const auto number = zip_file_add(archive, name.c_str(), data, ZIP_FL_ENC_UTF_8);
   if (number < 0) {
      zip_source_free(data);
      return failed();
   }
   const auto entry = static_cast<zip_uint64_t>(number);
   const bool packed = name.ends_with(".json") || name.ends_with(".model"); // the rest is small or compressed
   if (zip_set_file_compression(archive, entry, packed ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 6) != 0 ||
       zip_file_set_dostime(archive, entry, kDosTime, kDosDate, 0) != 0)
      return failed();
   return {};
}

} // namespace

Result<std::string> writeArchive(const Entries &entries)
{
   zip_error_t error;
   zip_error_init(&error);
   Source target(zip_source_buffer_create(nullptr, 0, 0, &error));
   Archive archive(target ? zip_open_from_source(target.get(), ZIP_TRUNCATE, &error) : nullptr);
   if (!archive)
      return Error{ErrorCode::internal, fmt::format("packing failed: {}", zip_error_strerror(&error))};
   zip_source_keep(target.get()); // one reference is the archive's
   for (const auto &[name, content] : entries)
      if (const auto added = addEntry(archive.get(), name, content); !added)
         return added.error();
   if (zip_close(archive.get()) != 0)
      return Error{ErrorCode::internal, fmt::format("packing failed: {}", zip_strerror(archive.get()))};
   static_cast<void>(archive.release()); // closed
   return drain(target.get());
}

Result<Entries> readArchive(std::string_view bytes, const std::string &name, std::size_t entryLimit,
                            std::uint64_t byteLimit)
{
   const auto refuse = [&name](std::string_view why) {
      return Error{ErrorCode::unreadable, fmt::format("{}: {}; restore the file from a copy", name, why)};
   };
   zip_error_t error;
   zip_error_init(&error);
   Source source(zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error));
   Archive archive(source ? zip_open_from_source(source.get(), ZIP_RDONLY | ZIP_CHECKCONS, &error) : nullptr);
   if (!archive)
      return refuse(fmt::format("the zip is cut short or damaged ({})", zip_error_strerror(&error)));
   static_cast<void>(source.release()); // the archive's now
   const auto count = zip_get_num_entries(archive.get(), 0);
   if (count < 0 || static_cast<std::uint64_t>(count) > entryLimit)
      return refuse(
          fmt::format("the zip has {} entries, more than the {} a design may have", count, entryLimit));
   std::uint64_t total = 0;
   Entries entries;
   for (zip_uint64_t i = 0; i < static_cast<zip_uint64_t>(count); ++i) {
      zip_stat_t info;
      if (zip_stat_index(archive.get(), i, 0, &info) != 0 || !(info.valid & ZIP_STAT_SIZE) ||
          !(info.valid & ZIP_STAT_NAME))
         return refuse(fmt::format("entry {} of the zip is damaged", i));
      total += std::min(info.size, byteLimit);
      if (info.size > byteLimit || total > byteLimit)
         return refuse(fmt::format("the zip unpacks to more than the {} bytes a design may have", byteLimit));
      const std::unique_ptr<zip_file_t, int (*)(zip_file_t *)> file(zip_fopen_index(archive.get(), i, 0),
                                                                    zip_fclose);
      std::string content;
      char block[1 << 16];
      zip_int64_t got = 1;
      while (file && content.size() <= info.size && (got = zip_fread(file.get(), block, sizeof block)) > 0)
         content.append(block, static_cast<std::size_t>(got));
      if (!file || got < 0 || content.size() != info.size)
         return refuse(fmt::format("entry {} of the zip ({}) is damaged", i, info.name));
      if (!entries.emplace(info.name, std::move(content)).second)
         return refuse(fmt::format("the zip has two entries {}", info.name));
   }
   return entries;
}

} // namespace diatom
