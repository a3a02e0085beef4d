// A loaded plugin library. Loaded at first use, checked against its manifest, never unloaded.
#pragma once

#include "core/result.h"
#include "plugins/manifest.h"

#include <diatom/abi/core.h>

#include <atomic>
#include <cstdint>
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

   /// The minor of the interface that it was built with, and the least that it runs with.
   std::uint32_t abiMinor() const { return m_record->abi_minor; }
   std::uint32_t needsMinor() const { return m_record->needs_minor; }

   /// Counts exceptions that came out of its calls, and how many there were.
   void noteException() const { m_exceptions.fetch_add(1, std::memory_order_relaxed); }
   int exceptions() const { return m_exceptions.load(std::memory_order_relaxed); }

private:
   explicit Module(const diatom_module *record) : m_record(record) {}
   const diatom_module *m_record;
   mutable std::atomic<int> m_exceptions{0};
};

} // namespace diatom
