#include "core/user_folders.h"

#include <cstdlib>

namespace diatom {

namespace {

namespace fs = std::filesystem;

/// The specification has relative paths ignored.
fs::path namedFolder(const char *variable)
{
   const char *value = std::getenv(variable);
   return value && fs::path(value).is_absolute() ? fs::path(value) : fs::path();
}

fs::path userFolder(const char *variable, const char *belowHome)
{
   if (const fs::path named = namedFolder(variable); !named.empty())
      return named / "diatom";
   const fs::path home = namedFolder("HOME");
   return home.empty() ? home : home / belowHome / "diatom";
}

} // namespace

fs::path userDataFolder() { return userFolder("XDG_DATA_HOME", ".local/share"); }
fs::path userConfigFolder() { return userFolder("XDG_CONFIG_HOME", ".config"); }
fs::path userCacheFolder() { return userFolder("XDG_CACHE_HOME", ".cache"); }

} // namespace diatom
