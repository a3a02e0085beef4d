#include "plugins/catalogue.h"

#include "core/sanitizers.h"
#include "core/text.h"
#include "plugins/admission.h"
#include "plugins/c_values.h"
#include "plugins/module.h"
#include "plugins/worker_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <mutex>
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

Candidate examine(const fs::path &folder, Origin origin)
{
   Candidate candidate;
   candidate.folder = folder;
   candidate.origin = isInstalled(folder) ? Origin::installed : origin;
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

} // namespace

struct Catalogue::Loader
{
   struct Opened
   {
      std::shared_ptr<const Module> module;
      const void *table = nullptr;
      Values values;
   };

   Isolate isolate = Isolate::none;
   std::mutex mutex;
   std::map<std::string, Result<std::shared_ptr<const Module>>> modules; // by plugin id

   Result<std::shared_ptr<const Module>> module(const Candidate &candidate, const Job &job)
   {
      const std::lock_guard lock(mutex);
      const Manifest &manifest = candidate.manifest;
      const auto found = modules.find(manifest.id);
      if (found != modules.end())
         return found->second;
      if (const Status admitted = admit(candidate, job); !admitted) {
         if (admitted.error().code != ErrorCode::cancelled)
            modules.emplace(manifest.id, admitted.error());
         return admitted.error();
      }
      return modules.emplace(manifest.id, Module::load(manifest)).first->second;
   }

   bool isolated(const Offer &offer) const
   {
      if (offer.provided->interface != DIATOM_SOLVER_1)
         return false;
      const bool outside = offer.candidate->origin != Origin::installed;
      return isolate == Isolate::all || (isolate == Isolate::outside && outside && kMayFork);
   }

   Result<Opened> open(const Offer &offer, const Values &given, const Job &job)
   {
      const std::string &id = offer.provided->id;
      auto values = completeValues(offer.provided->parameters, given);
      if (!values)
         return Error{values.error().code, fmt::format("{}: {}", id, values.error().message)};
      if (isolated(offer)) {
         if (const Status admitted = admit(*offer.candidate, job); !admitted)
            return admitted.error();
         return Opened{nullptr, workerSolver(*offer.manifest, id), *std::move(values)};
      }
      auto loaded = module(*offer.candidate, job);
      if (!loaded)
         return loaded.error();
      if (const Status able = checkExceptions(*offer.candidate, **loaded); !able)
         return able.error();
      Opened opened{*loaded, (*loaded)->table(offer.provided->interface.c_str()), *std::move(values)};
      if (!opened.table)
         return Error{ErrorCode::unsupported,
                      fmt::format("{}: its plugin.json promises {}, its library has none", id,
                                  offer.provided->interface)};
      return opened;
   }

   /// A plugin from outside that let out so many exceptions is broken in this session; the user hears it once
   /// more, not with every frame.
   static Status checkExceptions(const Candidate &candidate, const Module &module)
   {
      constexpr int kMost = 3;
      if (candidate.origin == Origin::installed || module.exceptions() < kMost)
         return {};
      return Error{
          ErrorCode::unsupported,
          fmt::format("{} failed inside {} times and is off until Diatom is started again; tell its author",
                      candidate.manifest.id, kMost)};
   }
};

Catalogue::Catalogue() : m_loader(std::make_unique<Loader>()) {}
Catalogue::~Catalogue() = default;

std::shared_ptr<const Catalogue> Catalogue::find(const std::vector<PluginFolder> &folders, bool tryUnknown,
                                                 Isolate isolate)
{
   std::shared_ptr<Catalogue> catalogue(new Catalogue);
   catalogue->m_loader->isolate = isolate;
   std::set<fs::path> seen; // one folder may be reached by several search paths
   for (const PluginFolder &folder : folders)
      for (const fs::path &plugin : pluginFolders(folder.path)) {
         std::error_code error;
         const fs::path real = fs::canonical(plugin, error);
         if (error || seen.insert(real).second)
            catalogue->m_candidates.push_back(examine(plugin, folder.origin));
      }
   judgeOutsiders(catalogue->m_candidates, tryUnknown);
   settleDuplicates(catalogue->m_candidates);
   for (const Candidate &candidate : catalogue->m_candidates)
      if (candidate.accepted)
         for (const Provided &provided : candidate.manifest.provides)
            catalogue->m_offers.emplace_back(offerKey(provided.interface, provided.id),
                                             Offer{&provided, &candidate.manifest, &candidate});
   std::stable_sort(catalogue->m_offers.begin(), catalogue->m_offers.end(),
                    [](const auto &a, const auto &b) { return a.first < b.first; });
   return catalogue;
}

Error Catalogue::absent(std::string_view interface, std::string_view id) const
{
   for (const Candidate &candidate : m_candidates)
      for (const Provided &provided : candidate.manifest.provides)
         if (!candidate.accepted && provided.interface == interface && provided.id == id)
            return {ErrorCode::unsupported, fmt::format("{} cannot be used: the plugin in {}: {}", id,
                                                        candidate.folder.string(), candidate.verdict)};
   return {ErrorCode::unsupported,
           fmt::format("nothing installed provides {} as {}; `diatom plugins` lists what there is", id,
                       interface)};
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
   if (m_loader->isolated(found)) {
      const void *table = workerSolver(*found.manifest, std::string(id));
      return std::make_shared<const Instance>(nullptr, std::string(id), table, self, destroy(table));
   }
   auto module = m_loader->module(*found.candidate, job); // loaded by the call above
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
   if (!found)
      return absent(interface, id);
   auto opened = m_loader->open(*found, values, job);
   if (!opened)
      return opened.error();
   const CValues record(opened->values);
   const std::string name(id), folder = found->manifest->folder.string();
   const diatom_create request{sizeof(diatom_create), name.c_str(), folder.c_str(), &record.record};
   std::int32_t status = DIATOM_EXCEPTION; // what stays when an exception comes out
   Status done = guardedCall(name, function, job, [&](const diatom_call *hostCall) {
      return status = call(opened->table, hostCall, &request);
   });
   if (status == DIATOM_EXCEPTION && opened->module)
      opened->module->noteException();
   return done;
}

} // namespace diatom
