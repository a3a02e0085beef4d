#include "plugins/trust.h"

#include "core/file.h"
#include "core/user_folders.h"

#include <nlohmann/json.hpp>

namespace diatom {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kTrustSchema = 1;

fs::path trustFile()
{
   const fs::path folder = userConfigFolder();
   return folder.empty() ? folder : folder / "trusted_plugins.json";
}

json trustList()
{
   constexpr std::uint64_t kLimit = 16 << 20;
   std::error_code ignored;
   json list = json::array();
   if (trustFile().empty() || !fs::exists(trustFile(), ignored))
      return list;
   const auto bytes = readFile(trustFile(), kLimit);
   const json document = bytes.ok() ? json::parse(*bytes, nullptr, false) : json();
   if (!document.is_object() || document.value("schema", json()) != kTrustSchema ||
       !document.value("trusted", json()).is_array())
      return list;
   for (const json &one : document["trusted"])
      if (one.is_object() && one.value("sha256", json()).is_string())
         list.push_back(one);
   return list;
}

} // namespace

std::set<std::string> trustedLibraries()
{
   std::set<std::string> trusted;
   for (const json &one : trustList())
      trusted.insert(one["sha256"].get<std::string>());
   return trusted;
}

Status trustLibrary(const std::string &hash, const std::string &id)
{
   if (trustFile().empty())
      return Error{ErrorCode::unwritable, "there is no folder for settings; set HOME or XDG_CONFIG_HOME"};
   json list = trustList();
   for (const json &one : list)
      if (one["sha256"] == hash)
         return {};
   list.push_back({{"id", id}, {"sha256", hash}});
   if (Status made = makeFolder(trustFile().parent_path()); !made)
      return made;
   return writeFileAtomic(trustFile(), json{{"schema", kTrustSchema}, {"trusted", std::move(list)}}.dump(
                                           1, ' ', false, json::error_handler_t::replace) +
                                           "\n");
}

} // namespace diatom
