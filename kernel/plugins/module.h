// A loaded plugin library. Loaded at first use, checked against its manifest, never unloaded.
#pragma once

#include "core/result.h"
#include "plugins/manifest.h"

#include <diatom/abi/core.h>

#include <memory>
#include <string>

namespace diatom {

/// Any thread once loaded.
class Module
{
public:
   static Result<std::shared_ptr<const Module>> load(const Manifest &manifest);

   /// The table of an interface, or null.
   const void *table(const char *interface) const { return m_record->get(interface); }

private:
   explicit Module(const diatom_module *record) : m_record(record) {}
   const diatom_module *m_record;
};

} // namespace diatom
