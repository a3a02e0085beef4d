#include "plugins/origin.h"

#include "core/user_folders.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>

namespace diatom {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> installationFolders()
{
   std::error_code error;
   const fs::path executable = fs::read_symlink("/proc/self/exe", error);
   if (error)
      return {};
   return {executable.parent_path() / "../plugins", executable.parent_path() / "../lib/diatom/plugins/1"};
}

} // namespace

std::vector<PluginFolder> defaultPluginFolders()
{
   std::vector<PluginFolder> folders;
   if (const char *path = std::getenv("DIATOM_PLUGIN_PATH")) {
      std::istringstream stream(path);
      for (std::string folder; std::getline(stream, folder, ':');)
         if (fs::path(folder).is_absolute())
            folders.emplace_back(folder);
   }
   if (const fs::path data = userDataFolder(); !data.empty())
      folders.emplace_back(data / "plugins/1", Origin::user);
   for (const fs::path &folder : installationFolders())
      folders.emplace_back(folder, Origin::installed);
   return folders;
}

bool isInstalled(const fs::path &folder)
{
   static const std::vector<fs::path> installation = [] {
      std::vector<fs::path> found;
      for (const fs::path &one : installationFolders()) {
         std::error_code error;
         if (const fs::path real = fs::canonical(one, error); !error)
            found.push_back(real);
      }
      return found;
   }();
   std::error_code error;
   const fs::path real = fs::canonical(folder, error);
   return !error && std::any_of(installation.begin(), installation.end(), [&](const fs::path &one) {
      return std::mismatch(one.begin(), one.end(), real.begin(), real.end()).first == one.end();
   });
}

} // namespace diatom
