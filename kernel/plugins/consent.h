// What the user decides about plugins from outside the installation.
#pragma once

#include "plugins/catalogue.h"

#include <string>
#include <vector>

namespace diatom {

/// A library that a decision was about.
struct Decided
{
   const Candidate *candidate = nullptr;
   std::string hash; // SHA-256
};

/// Trusts the libraries of this plugin id that lie in the user's plugin folder, as they are now.
Result<std::vector<Decided>> trustPlugin(const Catalogue &catalogue, const std::string &id);

/// Forgets how libraries stood their trial, so that they are tried again: those of one plugin id, or of all
/// with
/// "". Only from outside the installation.
Result<std::vector<Decided>> retryPlugins(const Catalogue &catalogue, const std::string &id);

} // namespace diatom
