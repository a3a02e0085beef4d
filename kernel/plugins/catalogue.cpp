#include "plugins/catalogue.h"

#include "core/text.h"
#include "plugins/module.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>

namespace diatom {

namespace {

namespace fs = std::filesystem;

std::string offerKey(std::string_view interface, std::string_view id)
{
   return fmt::format("{} {}", interface, id);
}

std::vector<std::int64_t> versionNumbers(const std::string &version)
{
   std::vector<std::int64_t> numbers;
   std::istringstream stream(version);
   for (std::string piece; std::getline(stream, piece, '.');)
      numbers.push_back(parseInteger(piece).value_or(0));
   return numbers;
}

std::vector<fs::path> subfolders(const fs::path &folder)
{
   std::vector<fs::path> found;
   std::error_code error;
   for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
      std::error_code ignored;
      if (entry->is_directory(ignored))
         found.push_back(entry->path());
   }
   std::sort(found.begin(), found.end());
   return found;
}

/// Folders with a plugin.json, one or two levels below `folder`, in order of their names.
std::vector<fs::path> pluginFolders(const fs::path &folder)
{
   std::vector<fs::path> found;
   const auto isPlugin = [](const fs::path &path) {
      std::error_code ignored;
      return fs::exists(path / "plugin.json", ignored);
   };
   for (const fs::path &outer : subfolders(folder)) {
      if (isPlugin(outer)) {
         found.push_back(outer);
         continue;
      }
      for (const fs::path &inner : subfolders(outer))
         if (isPlugin(inner))
            found.push_back(inner);
   }
   return found;
}

Candidate examine(const fs::path &folder)
{
   Candidate candidate;
   candidate.folder = folder;
   auto manifest = readManifest(folder);
   if (!manifest) {
      candidate.verdict = manifest.error().message;
      return candidate;
   }
   candidate.manifest = *std::move(manifest);
   const Manifest &m = candidate.manifest;
   std::error_code ignored;
   if (m.abiMajor != DIATOM_ABI_MAJOR)
      candidate.verdict = fmt::format("it is built for plugin interface {}, this version has {}", m.abiMajor,
                                      DIATOM_ABI_MAJOR);
   else if (m.abiNeeds > DIATOM_ABI_MINOR)
      candidate.verdict =
          fmt::format("it needs plugin interface {}.{}, this version has {}.{}; update Diatom", m.abiMajor,
                      m.abiNeeds, DIATOM_ABI_MAJOR, DIATOM_ABI_MINOR);
   else if (!fs::exists(folder / m.library, ignored))
      candidate.verdict = fmt::format("its library {} is not there; install the plugin again", m.library);
   else {
      candidate.accepted = true;
      candidate.verdict = "ok";
   }
   return candidate;
}

/// Of plugins with the same id the higher version stays accepted, of equal versions the earlier path.
void settleDuplicates(std::vector<Candidate> &candidates)
{
   std::map<std::string, std::size_t> best;
   for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (!candidates[i].accepted)
         continue;
      const auto [entry, first] = best.try_emplace(candidates[i].manifest.id, i);
      if (first)
         continue;
      const bool newer = versionNumbers(candidates[i].manifest.version) >
                         versionNumbers(candidates[entry->second].manifest.version);
      const std::size_t loser = newer ? entry->second : i;
      const std::size_t winner = newer ? i : entry->second;
      candidates[loser].accepted = false;
      candidates[loser].verdict =
          fmt::format("version {} in {} is used instead", candidates[winner].manifest.version,
                      candidates[winner].folder.string());
      entry->second = winner;
   }
}

/// The C form of completed values; the arrays point into `values`.
struct CValues
{
   explicit CValues(const Values &values)
   {
      for (const auto &[parameter, value] : values) {
         name.push_back(parameter.c_str());
         const auto *number = std::get_if<double>(&value);
         numbers.push_back(number ? *number : 0);
         text.push_back(number ? "" : std::get<std::string>(value).c_str());
      }
      record = {sizeof(diatom_values), static_cast<std::int64_t>(name.size()), name.data(), numbers.data(),
                text.data()};
   }
   CValues(const CValues &) = delete;
   CValues &operator=(const CValues &) = delete;

   std::vector<const char *> name, text;
   std::vector<double> numbers;
   diatom_values record{};
};

} // namespace

struct Catalogue::Loader
{
   struct Opened
   {
      std::shared_ptr<const Module> module;
      const void *table = nullptr;
      Values values;
   };

   std::mutex mutex;
   std::map<std::string, Result<std::shared_ptr<const Module>>> modules; // by plugin id

   Result<std::shared_ptr<const Module>> module(const Manifest &manifest)
   {
      const std::lock_guard lock(mutex);
      const auto found = modules.find(manifest.id);
      if (found != modules.end())
         return found->second;
      return modules.emplace(manifest.id, Module::load(manifest)).first->second;
   }

   Result<Opened> open(const Offer *offer, std::string_view interface, std::string_view id,
                       const Values &given)
   {
      if (!offer)
         return Error{ErrorCode::unsupported,
                      fmt::format("nothing installed provides {} as {}; `diatom plugins` lists what there is",
                                  id, interface)};
      auto values = completeValues(offer->provided->parameters, given);
      if (!values)
         return Error{values.error().code, fmt::format("{}: {}", id, values.error().message)};
      auto loaded = module(*offer->manifest);
      if (!loaded)
         return loaded.error();
      Opened opened{*loaded, (*loaded)->table(offer->provided->interface.c_str()), *std::move(values)};
      if (!opened.table)
         return Error{ErrorCode::unsupported,
                      fmt::format("{}: its plugin.json promises {}, its library has none", id, interface)};
      return opened;
   }
};

Catalogue::Catalogue() : m_loader(std::make_unique<Loader>()) {}
Catalogue::~Catalogue() = default;

std::shared_ptr<const Catalogue> Catalogue::find(const std::vector<fs::path> &folders)
{
   std::shared_ptr<Catalogue> catalogue(new Catalogue);
   std::set<fs::path> seen; // one folder may be reached by several search paths
   for (const fs::path &folder : folders)
      for (const fs::path &plugin : pluginFolders(folder)) {
         std::error_code error;
         const fs::path real = fs::canonical(plugin, error);
         if (error || seen.insert(real).second)
            catalogue->m_candidates.push_back(examine(plugin));
      }
   settleDuplicates(catalogue->m_candidates);
   for (const Candidate &candidate : catalogue->m_candidates)
      if (candidate.accepted)
         for (const Provided &provided : candidate.manifest.provides)
            catalogue->m_offers.emplace_back(offerKey(provided.interface, provided.id),
                                             Offer{&provided, &candidate.manifest});
   std::stable_sort(catalogue->m_offers.begin(), catalogue->m_offers.end(),
                    [](const auto &a, const auto &b) { return a.first < b.first; });
   return catalogue;
}

std::vector<fs::path> Catalogue::defaultFolders()
{
   std::vector<fs::path> folders;
   if (const char *path = std::getenv("DIATOM_PLUGIN_PATH")) {
      std::istringstream stream(path);
      for (std::string folder; std::getline(stream, folder, ':');)
         if (fs::path(folder).is_absolute())
            folders.emplace_back(folder);
   }
   const char *data = std::getenv("XDG_DATA_HOME");
   const char *home = std::getenv("HOME");
   if (data && fs::path(data).is_absolute())
      folders.push_back(fs::path(data) / "diatom/plugins/1");
   else if (home && fs::path(home).is_absolute())
      folders.push_back(fs::path(home) / ".local/share/diatom/plugins/1");
   std::error_code error;
   const fs::path executable = fs::read_symlink("/proc/self/exe", error);
   if (!error) {
      folders.push_back(executable.parent_path() / "../plugins");
      folders.push_back(executable.parent_path() / "../lib/diatom/plugins/1");
   }
   return folders;
}

std::vector<Offer> Catalogue::offers(std::string_view interface) const
{
   std::vector<Offer> found;
   for (const auto &[key, offer] : m_offers)
      if (offer.provided->interface == interface)
         found.push_back(offer);
   return found;
}

const Offer *Catalogue::offer(std::string_view interface, std::string_view id) const
{
   const std::string key = offerKey(interface, id);
   const auto found =
       std::lower_bound(m_offers.begin(), m_offers.end(), key,
                        [](const auto &entry, const std::string &k) { return entry.first < k; });
   return found != m_offers.end() && found->first == key ? &found->second : nullptr;
}

Result<std::shared_ptr<const Instance>> Catalogue::createWith(std::string_view interface, std::string_view id,
                                                              const Values &values, const Job &job,
                                                              const Create &create,
                                                              const DestroyOf &destroy) const
{
   void *self = nullptr;
   const Status made =
       callWith(interface, id, values, "create", job,
                [&](const void *table, const diatom_call *call, const diatom_create *request) {
                   return create(table, call, request, &self);
                });
   if (!made)
      return made.error();
   if (!self)
      return Error{ErrorCode::internal,
                   fmt::format("{} (create): it said it succeeded but made nothing", id)};
   const Offer &found = *offer(interface, id);
   auto module = m_loader->module(*found.manifest); // loaded by the call above
   if (!module)
      return module.error();
   const void *table = (*module)->table(found.provided->interface.c_str());
   return std::make_shared<const Instance>(*std::move(module), std::string(id), table, self, destroy(table));
}

Status Catalogue::callWith(
    std::string_view interface, std::string_view id, const Values &values, const char *function,
    const Job &job,
    const std::function<std::int32_t(const void *, const diatom_call *, const diatom_create *)> &call) const
{
   const Offer *found = offer(interface, id);
   auto opened = m_loader->open(found, interface, id, values);
   if (!opened)
      return opened.error();
   const CValues record(opened->values);
   const std::string name(id), folder = found->manifest->folder.string();
   const diatom_create request{sizeof(diatom_create), name.c_str(), folder.c_str(), &record.record};
   return guardedCall(name, function, job,
                      [&](const diatom_call *hostCall) { return call(opened->table, hostCall, &request); });
}

} // namespace diatom
