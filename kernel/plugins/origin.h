// Where plugins are looked for, and what that means for running them.
#pragma once

#include <filesystem>
#include <vector>

namespace diatom {

/// Installed with the program: run as they are. Chosen by --plugins or DIATOM_PLUGIN_PATH: an unknown library
/// is tried in a process of its own first. From the user's plugin folder: only with the user's consent, then
/// likewise.
enum class Origin { installed, chosen, user };

struct PluginFolder
{
   PluginFolder(std::filesystem::path folder, Origin from = Origin::chosen)
       : path(std::move(folder)), origin(from)
   {}
   std::filesystem::path path;
   Origin origin;
};

/// DIATOM_PLUGIN_PATH (colon list of absolute paths), $XDG_DATA_HOME/diatom/plugins/1, then beside the
/// executable: <bin>/../plugins and <bin>/../lib/diatom/plugins/1. Never the current directory.
std::vector<PluginFolder> defaultPluginFolders();

/// Whether a folder lies in the program's own installation, by whatever path it was found.
bool isInstalled(const std::filesystem::path &folder);

} // namespace diatom
