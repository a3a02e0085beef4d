// Reference meshes between Design and JSON.
#include "document/format.h"

#include <fmt/format.h>

#include <set>

namespace diatom {

nlohmann::ordered_json referenceMeshJson(const ReferenceMesh &reference)
{
   const Vec3 &p = reference.position;
   nlohmann::ordered_json json = {{"name", reference.name}, {"file", reference.file}};
   if (reference.unit > 0)
      json["unit_m"] = reference.unit;
   if (!p.isZero(0))
      json["position_m"] = {p[0], p[1], p[2]};
   if (!reference.shown)
      json["shown"] = false;
   return json;
}

ReferenceMesh readReferenceMesh(const JsonPlace &place)
{
   ReferenceMesh reference;
   if (!place.object())
      return reference;
   place.known({"name", "file", "unit_m", "position_m", "shown"});
   reference.name = place.at("name").text();
   reference.file = place.at("file").text();
   if (place.ok() && reference.name.empty())
      place.at("name").mustBe("a name");
   if (place.ok() && reference.file.empty())
      place.at("file").mustBe("the path of a mesh");
   reference.unit = place.numberOr("unit_m", 0, 0, 1e6);
   if (place.has("position_m")) {
      const auto p = place.at("position_m").numbers3();
      reference.position = {p[0], p[1], p[2]};
   }
   reference.shown = place.booleanOr("shown", true);
   return reference;
}

std::vector<ReferenceMesh> readReferenceMeshes(const JsonPlace &list)
{
   std::vector<ReferenceMesh> references;
   std::set<std::string> names;
   for (std::size_t i = 0; i < list.size() && list.ok(); ++i) {
      const auto place = list.at(i);
      references.push_back(readReferenceMesh(place));
      if (place.ok() && !names.insert(references.back().name).second)
         place.at("name").fail(
             fmt::format("there are two reference meshes \"{}\"; rename one", references.back().name));
   }
   return references;
}

} // namespace diatom
