// Consent of the user to run plugins from the own plugin folder: native code with the user's rights.
#pragma once

#include "core/result.h"

#include <set>
#include <string>

namespace diatom {

/// SHA-256 of the libraries that the user trusts. Empty when nothing was ever trusted; what is damaged trusts
/// nothing.
std::set<std::string> trustedLibraries();

/// Adds one to the list in the user's configuration folder. `id` of its plugin is for people who read the
/// file.
Status trustLibrary(const std::string &hash, const std::string &id);

} // namespace diatom
