#include "plugins/manifest.h"

#include "core/file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

using nlohmann::json;

/// Carries the first fault out of the nested readers; never leaves this file.
struct Fault
{
   std::string text;
};

const json &member(const json &object, const char *key, const std::string &place)
{
   const auto found = object.find(key);
   if (found == object.end())
      throw Fault{fmt::format("{}/{} is missing", place, key)};
   return *found;
}

std::string textAt(const json &object, const char *key, const std::string &place)
{
   const json &value = member(object, key, place);
   if (!value.is_string() || value.get_ref<const std::string &>().empty())
      throw Fault{fmt::format("{}/{} must be text", place, key)};
   return value.get<std::string>();
}

std::string optionalText(const json &object, const char *key, const std::string &place)
{
   return object.contains(key) ? textAt(object, key, place) : std::string();
}

double numberAt(const json &object, const char *key, const std::string &place)
{
   const json &value = member(object, key, place);
   if (!value.is_number() || !std::isfinite(value.get<double>()))
      throw Fault{fmt::format("{}/{} must be a number", place, key)};
   return value.get<double>();
}

int integerAt(const json &object, const char *key, const std::string &place)
{
   const json &value = member(object, key, place);
   if (!value.is_number_integer() || value.get<std::int64_t>() < 0 || value.get<std::int64_t>() > 1'000'000)
      throw Fault{fmt::format("{}/{} must be a whole number", place, key)};
   return value.get<int>();
}

const json &arrayAt(const json &object, const char *key, const std::string &place)
{
   const json &value = member(object, key, place);
   if (!value.is_array())
      throw Fault{fmt::format("{}/{} must be a list", place, key)};
   return value;
}

void requireObject(const json &value, const std::string &place)
{
   if (!value.is_object())
      throw Fault{fmt::format("{} must be an object", place.empty() ? "the file" : place)};
}

Parameter::Kind kindAt(const json &object, const std::string &place)
{
   const std::string kind = textAt(object, "kind", place);
   if (kind == "number")
      return Parameter::Kind::number;
   if (kind == "integer")
      return Parameter::Kind::integer;
   if (kind == "choice")
      return Parameter::Kind::choice;
   if (kind == "text")
      return Parameter::Kind::text;
   throw Fault{fmt::format("{}/kind is \"{}\"; it must be number, integer, choice or text", place, kind)};
}

Parameter readParameter(const json &object, const std::string &place)
{
   requireObject(object, place);
   Parameter parameter;
   parameter.name = textAt(object, "name", place);
   parameter.kind = kindAt(object, place);
   parameter.help = optionalText(object, "help", place);
   if (object.contains("unit") && object["unit"].is_string())
      parameter.unit = object["unit"].get<std::string>();
   if (parameter.kind == Parameter::Kind::number || parameter.kind == Parameter::Kind::integer) {
      parameter.number = numberAt(object, "default", place);
      parameter.minimum = numberAt(object, "min", place);
      parameter.maximum = numberAt(object, "max", place);
      if (!(parameter.minimum <= parameter.number && parameter.number <= parameter.maximum))
         throw Fault{fmt::format("{}: the default does not lie between min and max", place)};
      return parameter;
   }
   parameter.text = object.contains("default") && object["default"].is_string()
                        ? object["default"].get<std::string>()
                        : throw Fault{fmt::format("{}/default must be text", place)};
   if (parameter.kind == Parameter::Kind::choice) {
      for (const json &choice : arrayAt(object, "choices", place))
         parameter.choices.push_back(choice.is_string() ? choice.get<std::string>()
                                                        : throw Fault{place + "/choices must be texts"});
      if (std::find(parameter.choices.begin(), parameter.choices.end(), parameter.text) ==
          parameter.choices.end())
         throw Fault{fmt::format("{}/default is not one of the choices", place)};
   }
   return parameter;
}

Provided readProvided(const json &object, const std::string &place)
{
   requireObject(object, place);
   Provided provided;
   provided.interface = textAt(object, "interface", place);
   provided.id = textAt(object, "id", place);
   provided.name = textAt(object, "name", place);
   provided.summary = optionalText(object, "summary", place);
   if (object.contains("parameters")) {
      std::size_t n = 0;
      for (const json &parameter : arrayAt(object, "parameters", place))
         provided.parameters.push_back(readParameter(parameter, fmt::format("{}/parameters/{}", place, n++)));
   }
   return provided;
}

Manifest readDocument(const json &document)
{
   requireObject(document, "");
   if (const int schema = integerAt(document, "schema", ""); schema != 1)
      throw Fault{fmt::format("/schema is {}; this version reads 1", schema)};
   Manifest manifest;
   manifest.id = textAt(document, "id", "");
   manifest.version = textAt(document, "version", "");
   manifest.name = textAt(document, "name", "");
   manifest.license = optionalText(document, "license", "");
   manifest.summary = optionalText(document, "summary", "");
   manifest.library = textAt(document, "library", "");
   if (manifest.library.find('/') != std::string::npos)
      throw Fault{"/library must be a file name in the plugin's own folder"};
   const json &abi = member(document, "abi", "");
   requireObject(abi, "/abi");
   manifest.abiMajor = integerAt(abi, "major", "/abi");
   manifest.abiMinor = integerAt(abi, "minor", "/abi");
   manifest.abiNeeds = integerAt(abi, "needs", "/abi");
   std::size_t n = 0;
   for (const json &provided : arrayAt(document, "provides", ""))
      manifest.provides.push_back(readProvided(provided, fmt::format("/provides/{}", n++)));
   if (document.contains("replaces"))
      for (const json &id : arrayAt(document, "replaces", ""))
         if (id.is_string())
            manifest.replaces.push_back(id.get<std::string>());
   return manifest;
}

} // namespace

Result<Manifest> parseManifest(std::string_view bytes, const std::filesystem::path &folder)
{
   const std::string file = (folder / "plugin.json").string();
   try {
      Manifest manifest = readDocument(json::parse(bytes));
      manifest.folder = folder;
      manifest.bytes = bytes;
      return manifest;
   } catch (const Fault &fault) {
      return Error{ErrorCode::unreadable,
                   fmt::format("{}: {}; the plugin's author must mend it", file, fault.text)};
   } catch (const json::exception &exception) {
      return Error{ErrorCode::unreadable,
                   fmt::format("{}: it is not valid JSON ({}); the plugin's author must mend it", file,
                               exception.what())};
   }
}

Result<Manifest> readManifest(const std::filesystem::path &folder)
{
   constexpr std::uint64_t kLimit = 1 << 20; // a manifest is a page or two
   auto bytes = readFile(folder / "plugin.json", kLimit);
   if (!bytes)
      return bytes.error();
   return parseManifest(*bytes, folder);
}

} // namespace diatom
