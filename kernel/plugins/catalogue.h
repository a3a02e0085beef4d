// Every plugin found, with its verdict, and the door through which its things are created.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "plugins/instance.h"
#include "plugins/manifest.h"
#include "plugins/origin.h"
#include "plugins/values.h"

#include <diatom/abi/lattice.h>
#include <diatom/abi/machine.h>
#include <diatom/abi/parts.h>
#include <diatom/abi/solver.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// A folder that holds a plugin.json, and what became of it. Nothing is skipped in silence.
struct Candidate
{
   std::filesystem::path folder;
   Origin origin = Origin::installed;
   Manifest manifest; // empty when unreadable
   bool accepted = false;
   bool needsConsent = false; // turned away only because the user has not said yet that it may run
   std::string verdict;       // "ok", or the reason in one sentence

   std::filesystem::path library() const { return folder / manifest.library; }
};

/// One thing on offer.
struct Offer
{
   const Provided *provided = nullptr;
   const Manifest *manifest = nullptr;
   const Candidate *candidate = nullptr;
};

/// Which solvers run in a process of their own, where their crash costs a message; they give the same bits
/// there.
enum class Isolate {
   none,
   outside, // those that were not installed with the program
   all
};

/// Immutable after find(); modules are loaded at first use, under a lock. Any thread. A library from outside
/// the installation is tried in a process of its own before it is first loaded, and a plugin of the user's
/// folder runs only when the user trusts its library (plugins/consent.h).
class Catalogue
{
public:
   /// Looks in `folders` in order; within one, at <folder>/*/plugin.json and <folder>/*/*/plugin.json. Same
   /// id twice: the higher version wins, then the earlier path; the loser is listed with the reason. Loads
   /// nothing; with `tryUnknown`, libraries that were never tried are, each in a process of its own.
   static std::shared_ptr<const Catalogue> find(const std::vector<PluginFolder> &folders,
                                                bool tryUnknown = false, Isolate isolate = Isolate::none);

   const std::vector<Candidate> &candidates() const { return m_candidates; }
   /// Accepted things of one interface, ordered by id.
   std::vector<Offer> offers(std::string_view interface) const;
   /// Null when nothing installed provides it.
   const Offer *offer(std::string_view interface, std::string_view id) const;

   /// Loads the module if need be, checks and completes values, creates. `Table` is diatom_lattice,
   /// diatom_parts or diatom_machine; solvers take a scene: see moduleTable().
   template<typename Table>
   Result<std::shared_ptr<const Instance>> create(std::string_view interface, std::string_view id,
                                                  const Values &values, const Job &job) const
   {
      return createWith(
          interface, id, values, job,
          [](const void *table, const diatom_call *call, const diatom_create *create, void **self) {
             return static_cast<const Table *>(table)->create(call, create, self);
          },
          [](const void *table) { return static_cast<const Table *>(table)->destroy; });
   }

   using Create =
       std::function<std::int32_t(const void *table, const diatom_call *, const diatom_create *, void **)>;
   using DestroyOf = std::function<Instance::Destroy(const void *table)>;
   /// create() for interfaces whose create() takes more than values (solvers): `create` makes the call.
   Result<std::shared_ptr<const Instance>> createWith(std::string_view interface, std::string_view id,
                                                      const Values &values, const Job &job,
                                                      const Create &create, const DestroyOf &destroy) const;
   /// A call that needs no instance (capabilities, estimate): hands over the table and the completed create
   /// record.
   Status callWith(std::string_view interface, std::string_view id, const Values &values,
                   const char *function, const Job &job,
                   const std::function<std::int32_t(const void *table, const diatom_call *,
                                                    const diatom_create *)> &call) const;

   ~Catalogue();

private:
   Catalogue();
   struct Loader;
   /// Why nothing provides it: it is not installed, or what provides it was not accepted.
   Error absent(std::string_view interface, std::string_view id) const;
   std::vector<Candidate> m_candidates;
   std::vector<std::pair<std::string, Offer>> m_offers; // "interface id", sorted
   std::unique_ptr<Loader> m_loader;
};

} // namespace diatom
