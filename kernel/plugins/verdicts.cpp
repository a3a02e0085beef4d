#include "plugins/verdicts.h"

#include "core/file.h"
#include "core/sha256.h"
#include "core/user_folders.h"

#include <nlohmann/json.hpp>

namespace diatom {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kVerdictSchema = 1;

fs::path cacheFile()
{
   const fs::path folder = userCacheFolder();
   return folder.empty() ? folder : folder / "plugin_verdicts.json";
}

std::string keyOf(const fs::path &library)
{
   std::error_code error;
   const fs::path real = fs::canonical(library, error);
   return (error ? library : real).string();
}

} // namespace

Result<std::string> libraryHash(const fs::path &library)
{
   constexpr std::uint64_t kLimit = std::uint64_t{1} << 30;
   const auto bytes = readFile(library, kLimit);
   if (!bytes)
      return bytes.error();
   return sha256(*bytes);
}

Verdicts::Verdicts() : m_entries(load()) {}

std::map<std::string, Verdicts::Entry> Verdicts::load()
{
   std::map<std::string, Entry> entries;
   constexpr std::uint64_t kLimit = 16 << 20;
   std::error_code ignored;
   if (cacheFile().empty() || !fs::exists(cacheFile(), ignored))
      return entries;
   const auto bytes = readFile(cacheFile(), kLimit);
   const json document = bytes.ok() ? json::parse(*bytes, nullptr, false) : json();
   try {
      if (document.is_object() && document.at("schema") == kVerdictSchema)
         for (const auto &[path, one] : document.at("libraries").items()) {
            Entry entry{one.at("size"), one.at("time"), one.at("hash"), {}};
            if (one.contains("verdict"))
               entry.finding = TrialFinding{one.at("refused"), one.at("verdict")};
            entries[path] = std::move(entry);
         }
   } catch (const json::exception &) { // a damaged cache is one that knows nothing
      entries.clear();
   }
   return entries;
}

Verdicts::Entry *Verdicts::current(const fs::path &library)
{
   std::error_code error;
   const std::uint64_t size = fs::file_size(library, error);
   if (error)
      return nullptr;
   const auto written = fs::last_write_time(library, error);
   if (error)
      return nullptr;
   const auto time = static_cast<std::int64_t>(written.time_since_epoch().count());
   const std::string key = keyOf(library);
   Entry &entry = m_entries[key];
   if (!entry.hash.empty() && entry.size == size && entry.time == time)
      return &entry;
   auto hash = libraryHash(library);
   if (!hash)
      return nullptr;
   if (entry.hash != *hash)
      entry.finding.reset();
   entry.size = size;
   entry.time = time;
   entry.hash = *std::move(hash);
   m_changed[key] = true;
   return &entry;
}

Result<std::string> Verdicts::hash(const fs::path &library)
{
   if (const Entry *entry = current(library))
      return entry->hash;
   return Error{ErrorCode::unreadable, library.string() + ": it cannot be read; install the plugin again"};
}

std::optional<TrialFinding> Verdicts::finding(const fs::path &library)
{
   const Entry *entry = current(library);
   return entry ? entry->finding : std::nullopt;
}

void Verdicts::remember(const fs::path &library, const TrialFinding &finding)
{
   if (Entry *entry = current(library)) {
      entry->finding = finding;
      m_changed[keyOf(library)] = true;
   }
}

void Verdicts::forget(const fs::path &library)
{
   if (Entry *entry = current(library)) {
      entry->finding.reset();
      m_changed[keyOf(library)] = true;
   }
}

void Verdicts::save()
{
   if (m_changed.empty() || cacheFile().empty())
      return;
   std::map<std::string, Entry> entries = load(); // another process may have learnt something meanwhile
   for (const auto &[key, changed] : m_changed)
      entries[key] = m_entries[key];
   m_changed.clear();
   json libraries = json::object();
   std::error_code ignored;
   for (const auto &[path, entry] : entries) {
      if (entry.hash.empty() || !fs::exists(path, ignored))
         continue;
      json one{{"size", entry.size}, {"time", entry.time}, {"hash", entry.hash}};
      if (entry.finding) {
         one["refused"] = entry.finding->refused;
         one["verdict"] = entry.finding->text;
      }
      libraries[path] = std::move(one);
   }
   if (makeFolder(cacheFile().parent_path()).ok())
      (void)writeFileAtomic(cacheFile(),
                            json{{"schema", kVerdictSchema}, {"libraries", std::move(libraries)}}.dump(
                                1, ' ', false, json::error_handler_t::replace) +
                                "\n");
}

} // namespace diatom
