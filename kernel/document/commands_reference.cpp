// Commands on reference meshes.
#include "document/command_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace diatom {

namespace {

auto findReference(std::vector<ReferenceMesh> &referenceMeshes, const std::string &name)
{
   return std::find_if(referenceMeshes.begin(), referenceMeshes.end(),
                       [&](const ReferenceMesh &known) { return known.name == name; });
}

Result<std::string> referenceMesh(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "reference-mesh", arguments);
   const std::string name = edit.arguments().at("name").text();
   auto &referenceMeshes = edit.design().referenceMeshes;
   const auto known = findReference(referenceMeshes, name);
   // What is not given stays as it is.
   nlohmann::json merged =
       known == referenceMeshes.end() ? nlohmann::json::object() : nlohmann::json(referenceMeshJson(*known));
   if (edit.ok())
      merged.merge_patch(edit.arguments().json());
   std::error_code failed;
   if (merged.contains("file") && merged["file"].is_string() && !merged["file"].get<std::string>().empty())
      merged["file"] =
          std::filesystem::absolute(merged["file"].get<std::string>(), failed).lexically_normal().string();
   ReadLog log{"reference-mesh", {}, nlohmann::json::object()};
   const ReferenceMesh item = edit.ok() ? readReferenceMesh(JsonPlace(merged, log)) : ReferenceMesh();
   if (log.error)
      edit.fail(ErrorCode::usage, log.error->message.substr(log.name.size() + 2));
   if (edit.ok()) {
      if (known == referenceMeshes.end())
         referenceMeshes.push_back(item);
      else
         *known = item;
   }
   return edit.commit("reference mesh");
}

Result<std::string> removeReferenceMesh(CommandContext &context, const nlohmann::json &arguments)
{
   Edit edit(context, "remove-reference-mesh", arguments);
   const std::string name = edit.arguments().at("name").text();
   auto &referenceMeshes = edit.design().referenceMeshes;
   const auto known = findReference(referenceMeshes, name);
   if (edit.ok() && known == referenceMeshes.end())
      edit.fail(ErrorCode::invalid, fmt::format("there is no reference mesh \"{}\"", name));
   if (edit.ok())
      referenceMeshes.erase(known);
   return edit.commit("remove reference mesh");
}

constexpr CommandParameter kReference[] = {
    {"name", "text", true, "of the mesh; a known name changes that one"},
    {"file", "text", false, "the mesh; a relative path is from the current folder"},
    {"unit_m", "number", false, "metres per number in it; 0 = as the file or its format says"},
    {"position_m", "list", false, "where its origin lies"},
    {"shown", "boolean", false, "whether it is drawn"},
};
constexpr CommandParameter kReferenceName[] = {{"name", "text", true, "of the mesh"}};

constexpr Command kReferenceTable[] = {
    {"reference-mesh", "Show reference mesh", "Shows a mesh beside the cells, to design against.", kReference,
     referenceMesh},
    {"remove-reference-mesh", "Remove reference mesh", "Shows a mesh no longer; its file stays.",
     kReferenceName, removeReferenceMesh},
};

} // namespace

const std::span<const Command> kReferenceCommands = kReferenceTable;

} // namespace diatom
