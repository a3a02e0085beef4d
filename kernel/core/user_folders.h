// Where the files of a user belong, as the XDG base directory specification has it.
#pragma once

#include <filesystem>

namespace diatom {

/// Empty where the environment names neither the folder nor a home.
std::filesystem::path userDataFolder();   // $XDG_DATA_HOME/diatom
std::filesystem::path userConfigFolder(); // $XDG_CONFIG_HOME/diatom
std::filesystem::path userCacheFolder();  // $XDG_CACHE_HOME/diatom: may be deleted at any time

} // namespace diatom
