// The library as a whole: that it loads, what it exports, what it hands over for which id.
#include "plugin_check/checks.h"

#include "core/clock.h"
#include "core/sanitizers.h"
#include "plugins/c_values.h"
#include "plugins/instance.h"
#include "plugins/module.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <memory>
#include <sstream>

namespace diatom::check {

namespace {

constexpr double kLoadSeconds = 0.1 * kSlowdown;

std::shared_ptr<const Module> load(const Subject &subject, Findings &findings)
{
   auto module = Module::load(subject.manifest);
   if (!module)
      findings.fail(module.error().message);
   return module ? *module : nullptr;
}

void checkModuleLoads(const Subject &subject, Findings &findings)
{
   const auto begin = Clock::now();
   const auto module = load(subject, findings);
   const double seconds = secondsSince(begin);
   if (!module)
      return;
   if (seconds > kLoadSeconds)
      findings.warn(
          fmt::format("loading it takes {:.0f} ms, more than {:.0f}: what it prepares then, it had better "
                      "prepare when it is needed",
                      seconds * 1e3, kLoadSeconds * 1e3));
   if (static_cast<int>(module->needsMinor()) != subject.manifest.abiNeeds)
      findings.fail(fmt::format("plugin.json says that it needs interface {}.{}, the library {}.{}",
                                subject.manifest.abiMajor, subject.manifest.abiNeeds, DIATOM_ABI_MAJOR,
                                module->needsMinor()));
   if (static_cast<int>(module->abiMinor()) != subject.manifest.abiMinor)
      findings.warn(fmt::format("plugin.json says that it was built for interface {}.{}, the library {}.{}",
                                subject.manifest.abiMajor, subject.manifest.abiMinor, DIATOM_ABI_MAJOR,
                                module->abiMinor()));
}

/// The names that a library defines for others, by nm of binutils, which whoever builds plugins has.
std::vector<std::string> exportsOf(const std::string &file, bool &known)
{
   std::string quoted = "'";
   for (const char c : file)
      quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
   const std::unique_ptr<FILE, int (*)(FILE *)> pipe(
       ::popen(("nm -D --defined-only --format=posix " + quoted + "' 2>/dev/null").c_str(), "r"), ::pclose);
   std::string text;
   std::array<char, 4096> part;
   while (pipe && std::fgets(part.data(), static_cast<int>(part.size()), pipe.get()))
      text += part.data();
   known = !text.empty();
   std::vector<std::string> names;
   std::istringstream lines(text);
   for (std::string line; std::getline(lines, line);)
      names.push_back(line.substr(0, line.find(' ')));
   return names;
}

void checkModuleExports(const Subject &subject, Findings &findings)
{
   bool known = false;
   const auto names = exportsOf((subject.manifest.folder / subject.manifest.library).string(), known);
   if (!known)
      return findings.skip("nm (of binutils) is not installed");
   for (const std::string &name : names)
      if (name != DIATOM_MODULE_SYMBOL)
         return findings.fail(
             fmt::format("it exports {} ({} names in all), which can clash with other libraries: "
                         "build it by diatom_add_plugin(), or give the linker the SDK's exports.map",
                         name, names.size()));
}

void checkModuleInterfaces(const Subject &subject, Findings &findings)
{
   const auto module = load(subject, findings);
   if (!module)
      return;
   for (const Provided &one : subject.manifest.provides) {
      if (!module->table(one.interface.c_str()))
         findings.fail(fmt::format("plugin.json promises {} for {}, which the library does not have",
                                   one.interface, one.id));
      if (module->table((one.interface + "x").c_str()))
         findings.fail(
             fmt::format("it hands over a table for {}x, an interface that there is not: compare the "
                         "whole id",
                         one.interface));
   }
   for (const char *unknown : {"", "diatom.nothing/1", "diatom.lattice/999"})
      if (module->table(unknown))
         findings.fail(
             fmt::format("it hands over a table for \"{}\", an interface that there is not", unknown));
}

/// A thing of this id, asked of the library past the catalogue, which would not let it through.
template<typename Table>
bool makes(const Table &table, const Provided &provided, const std::string &id, const Subject &subject)
{
   const Values values = completeValues(provided.parameters, {}).value();
   const CValues record(values);
   const std::string folder = subject.manifest.folder.string();
   const diatom_create create{sizeof(diatom_create), id.c_str(), folder.c_str(), &record.record};
   void *self = nullptr;
   const Status made = guardedCall(
       id, "create", Job(), [&](const diatom_call *call) { return table.create(call, &create, &self); });
   if (made && self)
      table.destroy(self);
   return made.ok();
}

void checkModuleIds(const Subject &subject, Findings &findings)
{
   if (subject.manifest.provides.size() < 2)
      return findings.skip("it provides one thing, so that the id has nothing to tell");
   const auto module = load(subject, findings);
   if (!module)
      return;
   for (const Provided &one : subject.manifest.provides) {
      const std::string wrong = one.id + "x";
      const void *table = module->table(one.interface.c_str());
      bool made = false;
      if (!table)
         continue;
      if (one.interface == DIATOM_LATTICE_1)
         made = makes(*static_cast<const diatom_lattice *>(table), one, wrong, subject);
      else if (one.interface == DIATOM_PARTS_1)
         made = makes(*static_cast<const diatom_parts *>(table), one, wrong, subject);
      else if (one.interface == DIATOM_MACHINE_1)
         made = makes(*static_cast<const diatom_machine *>(table), one, wrong, subject);
      else if (one.interface == DIATOM_SOLVER_1) {
         const diatom_capabilities *capabilities = nullptr;
         made = guardedCall(wrong, "capabilities", Job(), [&](const diatom_call *call) {
                   return static_cast<const diatom_solver *>(table)->capabilities(call, wrong.c_str(),
                                                                                  &capabilities);
                }).ok();
      }
      if (made)
         findings.fail(
             fmt::format("asked for {}, which it does not provide, it answers as if it did", wrong));
   }
}

} // namespace

void addModuleChecks(std::vector<Check> &checks)
{
   checks.push_back(
       {kLoads, "the library loads, in no time, and is that of its plugin.json", nullptr, checkModuleLoads});
   checks.push_back({"module.exports", "it exports one name", nullptr, checkModuleExports});
   checks.push_back({"module.interfaces", "it has what plugin.json promises and nothing of another name",
                     nullptr, checkModuleInterfaces});
   checks.push_back({"module.ids", "it refuses ids that it does not provide", nullptr, checkModuleIds});
}

} // namespace diatom::check
