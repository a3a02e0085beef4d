#include "plugins/consent.h"

#include "core/user_folders.h"
#include "plugins/trust.h"
#include "plugins/verdicts.h"

#include <fmt/format.h>

namespace diatom {

namespace {

Error noSuchPlugin(const std::string &id, const std::string &where)
{
   return {ErrorCode::usage,
           fmt::format("there is no plugin {} {}; `diatom plugins` lists what there is", id, where)};
}

} // namespace

Result<std::vector<Decided>> trustPlugin(const Catalogue &catalogue, const std::string &id)
{
   std::vector<Decided> decided;
   for (const Candidate &candidate : catalogue.candidates()) {
      if (candidate.origin != Origin::user || candidate.manifest.id != id)
         continue;
      auto hash = libraryHash(candidate.library());
      if (!hash)
         return hash.error();
      if (const Status stored = trustLibrary(*hash, id); !stored)
         return stored.error();
      decided.push_back({&candidate, *std::move(hash)});
   }
   if (decided.empty())
      return noSuchPlugin(id, "in your own plugin folder " + (userDataFolder() / "plugins/1").string());
   return decided;
}

Result<std::vector<Decided>> retryPlugins(const Catalogue &catalogue, const std::string &id)
{
   std::vector<Decided> decided;
   Verdicts verdicts;
   for (const Candidate &candidate : catalogue.candidates()) {
      if (candidate.origin == Origin::installed || candidate.manifest.library.empty() ||
          (!id.empty() && candidate.manifest.id != id))
         continue;
      const auto hash = verdicts.hash(candidate.library());
      if (!hash)
         continue;
      verdicts.forget(candidate.library());
      decided.push_back({&candidate, *hash});
   }
   verdicts.save();
   if (decided.empty() && !id.empty())
      return noSuchPlugin(id, "from outside the installation");
   return decided;
}

} // namespace diatom
