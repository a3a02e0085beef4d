// A created thing of a plugin and the guard through which every call to it goes.
#pragma once

#include "core/job.h"
#include "core/result.h"

#include <diatom/abi/core.h>

#include <functional>
#include <memory>
#include <string>

namespace diatom {

class Module; // a loaded library; never unloaded

/// The guard: builds the diatom_call, saves and restores the floating-point mode, the locale and the working
/// directory, notes who is being called for a crash report, watches that cancel is answered, turns a status
/// and the reported text into a Result. Used for every call into a plugin, also before there is an instance.
/// `who` names the plugin in messages; `function` the table's entry.
Status guardedCall(const std::string &who, const char *function, const Job &job,
                   const std::function<std::int32_t(const diatom_call *)> &call);

/// Of a call that guardedCall() made: for tables that the host itself implements.
const Job &jobOf(const diatom_call *call);

/// One created thing: module, table and self. Destroyed with the last owner. Thread rules are the table's
/// own. A thing in another process has no module here.
class Instance
{
public:
   using Destroy = void (*)(void *self);

   Instance(std::shared_ptr<const Module> module, std::string id, const void *table, void *self,
            Destroy destroy);
   ~Instance();
   Instance(const Instance &) = delete;
   Instance &operator=(const Instance &) = delete;

   const std::string &id() const { return m_id; }
   void *self() const { return m_self; }
   /// The function table, of the type that belongs to the interface this was created for.
   template<typename Table>
   const Table *table() const
   {
      return static_cast<const Table *>(m_table);
   }
   /// guardedCall() with this thing's name.
   Status call(const char *function, const Job &job,
               const std::function<std::int32_t(const diatom_call *)> &call) const;

private:
   std::shared_ptr<const Module> m_module;
   std::string m_id;
   const void *m_table;
   void *m_self;
   Destroy m_destroy;
};

} // namespace diatom
