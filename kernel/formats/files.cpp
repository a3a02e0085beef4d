#include "formats/files.h"

#include "core/file.h"
#include "document/format.h"
#include "document/json_text.h"
#include "document/missing_lattice.h"
#include "formats/importers.h"
#include "formats/vox.h"
#include "formats/voxcad.h"
#include "io/mesh_read.h"

#include <fmt/format.h>

#include <fstream>

namespace diatom {

namespace {

constexpr std::uint64_t kMostText = std::uint64_t{256} << 20; // of JSON, plain or packed
constexpr std::uint64_t kMostPacked = std::uint64_t{4} << 30; // of a zip, packed or not
constexpr std::size_t kMostEntries = 100'000;
constexpr std::uint64_t kMostReadableCells = 200'000; // stored; with more, or more text, cells are packed
constexpr std::size_t kMostReadableText = std::size_t{1} << 20;
constexpr std::string_view kZipStart = "PK";

Error unreadable(const std::string &name, std::string_view why)
{
   return {ErrorCode::unreadable, fmt::format("{}: {}", name, why)};
}

Result<Opened> readDiatom(const nlohmann::json &json, const Entries &blocks, const std::string &name,
                          const Job &job)
{
   ReadLog log{name, {}, nlohmann::json::object()};
   const JsonPlace top(json, log);
   const auto version = top.at("diatom").integer(1, 1'000'000);
   if (log.error)
      return *log.error;
   if (version > kFormatVersion)
      return unreadable(
          name,
          fmt::format("/diatom: it was written by a newer version of Diatom (format {}, this one reads up to "
                      "{}); update Diatom to open it",
                      version, kFormatVersion));
   Opened opened{readDesignJson(json, blocks, log, job), "diatom", {}};
   if (log.error)
      return *log.error;
   for (const auto &[pointer, value] : opened.design.unknown.items())
      opened.notes.push_back(
          fmt::format("{} is unknown to this version; it is kept and saved again", pointer));
   return opened;
}

Result<Opened> readImported(const nlohmann::json &json, const std::string &name, const Job &job)
{
   ReadLog log{name, {}, nlohmann::json::object()};
   const JsonPlace top(json, log);
   const auto assembly = top.at("assembly");
   if (top.has("lattice"))
      return unreadable(
          name,
          "/lattice: files of DMDesign before May 2015 and of AMOEBA's rewrite of 2017 are not read; save "
          "the design again with the published version of that program");
   const bool gik = assembly.has("connectionType") && assembly.json()["connectionType"] == "gik";
   const bool amoeba = top.has("emSim") || (assembly.has("cells") && !gik);
   if (!amoeba && !assembly.has("sparseCells") && !top.has("materials"))
      return unreadable(
          name,
          "top level: it is JSON but no design (neither \"diatom\" nor \"assembly\" nor \"materials\"); name "
          "a .diatom document or a file of AMOEBA or DMDesign");
   Opened opened = amoeba ? importAmoeba(json, log, job) : importDmdesign(json, log, job);
   if (log.error)
      return *log.error;
   if (job.cancelled())
      return Error{ErrorCode::cancelled, fmt::format("{}: opening was cancelled", name)};
   opened.design.name = std::filesystem::path(name).stem().string();
   noteUnknown(opened, log);
   return opened;
}

Result<Opened> readText(std::string_view text, const Entries &blocks, const std::string &name, const Job &job)
{
   if (text.size() > kMostText)
      return unreadable(
          name, fmt::format("it is larger than the {} bytes that readable designs may have; save it packed",
                            kMostText));
   const auto start = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
   if (start == std::string_view::npos)
      return unreadable(
          name, "it is empty; name a .diatom document or a file of AMOEBA, DMDesign, MagicaVoxel or VoxCAD");
   if (text[start] != '{')
      return unreadable(
          name,
          fmt::format("byte {}: it is no design: neither JSON nor a zip begins like this; name a .diatom "
                      "document or a file of AMOEBA, DMDesign, MagicaVoxel or VoxCAD",
                      start + 1));
   auto json = parseJson(text, name);
   if (!json)
      return json.error();
   return json->contains("diatom") ? readDiatom(*json, blocks, name, job) : readImported(*json, name, job);
}

/// Whether a file begins as a zip does; false when it cannot be read (the full read says why).
bool beginsAsZip(const std::filesystem::path &file)
{
   char start[2] = {};
   std::ifstream in(file, std::ios::binary);
   return in.read(start, sizeof start) && std::string_view(start, sizeof start) == kZipStart;
}

} // namespace

namespace {

/// Documents name reference meshes from their own folder, designs by whole paths: so they can be saved
/// elsewhere.
void widenPaths(Design &design, const std::filesystem::path &file)
{
   std::error_code failed;
   const auto folder = std::filesystem::absolute(file, failed).parent_path();
   for (ReferenceMesh &reference : design.referenceMeshes)
      reference.file = (folder / reference.file).lexically_normal().string();
}

Design withNearPaths(Design design, const std::filesystem::path &file)
{
   std::error_code failed;
   const auto folder = std::filesystem::absolute(file, failed).parent_path();
   for (ReferenceMesh &reference : design.referenceMeshes) {
      const auto near = std::filesystem::path(reference.file).lexically_relative(folder);
      if (!near.empty() && *near.begin() != "..")
         reference.file = near.string();
   }
   return design;
}

} // namespace

Result<Opened> openDesign(const std::filesystem::path &file, const Job &job)
{
   if (isMeshFile(file))
      return unreadable(
          file.string(),
          fmt::format("it is a mesh and no design; fill it with cells: diatom convert {} OUT.diatom "
                      "--pitch 1mm",
                      file.filename().string()));
   const bool text = file != "-" && !beginsAsZip(file);
   auto bytes = readFile(file, text ? kMostText : kMostPacked);
   if (!bytes)
      return bytes.error();
   if (file == "-")
      return readDesign(*bytes, "standard input", job);
   auto opened = readDesign(*bytes, file.string(), job);
   if (opened)
      widenPaths(opened->design, file);
   return opened;
}

Result<Opened> readDesign(std::string_view bytes, const std::string &name, const Job &job)
{
   try {
      if (bytes.starts_with(kVoxStart))
         return readVox(bytes, name, job);
      if (isVoxcad(bytes))
         return readVoxcad(bytes, name, job);
      if (!bytes.starts_with(kZipStart))
         return readText(bytes, {}, name, job);
      auto entries = readArchive(bytes, name, kMostEntries, kMostPacked);
      if (!entries)
         return entries.error();
      const auto document = entries->find(kDocumentEntry);
      if (document == entries->end())
         return unreadable(name, fmt::format("the zip has no {}, so it is no design; name a .diatom document",
                                             kDocumentEntry));
      return readText(document->second, *entries, name, job);
   } catch (const std::bad_alloc &) {
      return unreadable(
          name, "there is not enough memory to open it; close other programs or use a larger machine");
   } catch (const nlohmann::json::exception &error) {
      return unreadable(name,
                        fmt::format("it cannot be used ({}); restore the file from a copy", error.what()));
   }
}

Status saveDesign(const Design &design, const std::filesystem::path &file, const Job &job)
{
   const bool many = storedCells(design.model) > kMostReadableCells;
   const Design written = withNearPaths(design, file);
   auto bytes = writeDesign(written, many, job);
   if (bytes && !many && bytes->size() > kMostReadableText)
      bytes = writeDesign(written, true, job);
   if (!bytes)
      return Error{bytes.error().code, fmt::format("{}: {}", file.string(), bytes.error().message)};
   return writeFileAtomic(file, *bytes);
}

Result<std::string> writeDesign(const Design &design, bool packed, const Job &job)
{
   try {
      Entries entries;
      auto json = designJson(design, packed ? &entries : nullptr, job);
      if (!json)
         return json.error();
      if (!packed)
         return jsonText(*json);
      entries.emplace(kDocumentEntry, jsonText(*json));
      return writeArchive(entries);
   } catch (const std::bad_alloc &) {
      return Error{ErrorCode::unwritable,
                   "there is not enough memory to write the design; close other programs"};
   } catch (const nlohmann::json::exception &error) {
      return Error{ErrorCode::invalid,
                   fmt::format("the design cannot be written as JSON ({})", error.what())};
   }
}

} // namespace diatom
