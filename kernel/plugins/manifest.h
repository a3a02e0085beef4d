// plugin.json: what a plugin is and provides, readable without loading any code.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// One parameter of a provided thing, as plugin.json declares it. Numbers are in `unit`'s SI base.
struct Parameter
{
   enum class Kind { number, integer, choice, text };
   std::string name;
   Kind kind = Kind::number;
   std::string unit;                // "m", "rad", "s", "" = none
   double number = 0;               // default, for number and integer
   double minimum = 0, maximum = 0; // inclusive, for number and integer
   std::string text;                // default, for choice and text
   std::vector<std::string> choices;
   std::string help;
};

/// One thing a module provides under an interface.
struct Provided
{
   std::string interface; // "diatom.lattice/1"
   std::string id;        // "org.diatom_cad.lattice.kelvin"
   std::string name;      // for menus
   std::string summary;
   std::vector<Parameter> parameters;
};

struct Manifest
{
   std::filesystem::path folder;
   std::string bytes; // of plugin.json as read
   std::string id, version, name, license, summary, library;
   int abiMajor = 0, abiMinor = 0, abiNeeds = 0;
   std::vector<Provided> provides;
   std::vector<std::string> replaces;
};

/// Reads and checks `folder`/plugin.json. The error names the file, the key and the remedy.
Result<Manifest> readManifest(const std::filesystem::path &folder);
/// The same for bytes already read; `folder` only appears in messages and in the result.
Result<Manifest> parseManifest(std::string_view bytes, const std::filesystem::path &folder);

} // namespace diatom
