#include "plugins/module.h"

#include "plugins/process_state.h"
#include "plugins/warnings.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace diatom {

namespace {

Status checkRecord(const Manifest &manifest, const std::string &file, const diatom_module &record)
{
   if (record.size < static_cast<std::int64_t>(sizeof(diatom_module)) || !record.get || !record.metadata)
      return Error{ErrorCode::unsupported,
                   fmt::format("{}: its {} is damaged; rebuild the plugin", file, DIATOM_MODULE_SYMBOL)};
   if (record.needs_minor > DIATOM_ABI_MINOR)
      return Error{ErrorCode::unsupported,
                   fmt::format("{}: it needs plugin interface {}.{}, this version has {}.{}; update Diatom",
                               file, DIATOM_ABI_MAJOR, record.needs_minor, DIATOM_ABI_MAJOR,
                               DIATOM_ABI_MINOR)};
   if (manifest.bytes != record.metadata)
      return Error{
          ErrorCode::unsupported,
          fmt::format("{}: it does not belong to the plugin.json beside it (half-updated install); install "
                      "the plugin again",
                      file)};
   return {};
}

} // namespace

Result<std::shared_ptr<const Module>> Module::load(const Manifest &manifest)
{
   const std::string file = (manifest.folder / manifest.library).string();
   ProcessState state;
   void *library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
   if (const std::string changed = state.restore(); !changed.empty())
      warnOfPlugin(
          fmt::format("{} changed {} while it was loaded, which a plugin must not do; it was put back",
                      manifest.id, changed));
   if (!library) {
      const char *why = ::dlerror();
      return Error{ErrorCode::unsupported,
                   fmt::format("{}: it cannot be loaded: {}", file, why ? why : "unknown reason")};
   }
   const auto *record = static_cast<const diatom_module *>(::dlsym(library, DIATOM_MODULE_SYMBOL));
   if (!record)
      return Error{ErrorCode::unsupported,
                   fmt::format("{}: it exports no {}, so it is not a Diatom plugin of interface {}", file,
                               DIATOM_MODULE_SYMBOL, DIATOM_ABI_MAJOR)};
   if (const Status fits = checkRecord(manifest, file, *record); !fits)
      return fits.error();
   return std::shared_ptr<const Module>(new Module(record));
}

} // namespace diatom
