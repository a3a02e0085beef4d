#include "document/format.h"

#include "document/cell_pack.h"
#include "document/cell_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace diatom {

namespace {

using nlohmann::ordered_json;

// --- writing
// -------------------------------------------------------------------------------------------------------

class Writer
{
public:
   Writer(const Design &design, Entries *blocks, const Job &job)
       : m_design(design), m_blocks(blocks), m_job(job)
   {}

   Result<ordered_json> write()
   {
      const auto &model = m_design.model;
      ordered_json json = {{"diatom", kFormatVersion},
                           {"name", m_design.name},
                           {"lattice",
                            {{"id", model.lattice.id},
                             {"values", valuesJson(model.lattice.values)},
                             {"pitch_m", model.lattice.pitch},
                             {"aspect", model.lattice.aspect}}},
                           {"materials", ordered_json::array()}};
      for (const auto &material : *model.materials)
         json["materials"].push_back(material.id.empty() ? ordered_json() : materialJson(material));
      if (!model.definitions.empty())
         json["definitions"] = definitions();
      json["assembly"] = body(model.root, "cells/assembly");
      json["simulation"] = setupJson(m_design.setup);
      const auto &assembly = m_design.assembly;
      if (!assembly.parts.empty() || !assembly.partsValues.empty())
         json["parts"] = {{"id", assembly.parts}, {"values", valuesJson(assembly.partsValues)}};
      json["machine"] = {{"id", assembly.machine}, {"values", valuesJson(assembly.machineValues)}};
      for (const ReferenceMesh &reference : m_design.referenceMeshes)
         json["reference_meshes"].push_back(referenceMeshJson(reference));
      putUnknown(json);
      if (m_error)
         return *m_error;
      return json;
   }

private:
   ordered_json definitions()
   {
      auto list = ordered_json::array();
      DefinitionId position = 0;
      for (const auto &[number, definition] : m_design.model.definitions) {
         ordered_json json = {
             {"id", definition->id}, {"name", definition->name}, {"color", colorText(definition->color)}};
         if (number != ++position)
            json["number"] = number; // after others were removed
         json.update(body(definition->body, fmt::format("cells/{}", number)));
         list.push_back(std::move(json));
      }
      return list;
   }

   ordered_json body(const Body &body, const std::string &entry)
   {
      auto json = ordered_json::object();
      if (!body.cells.empty())
         json["cells"] = cells(body.cells, entry);
      auto instances = ordered_json::array();
      body.instances.visit([&](const Placement &placement) {
         const auto *definition = m_design.model.definition(placement.definition);
         auto item = ordered_json::array({definition ? definition->id : "", indexJson(placement.origin)});
         if (placement.rotation != 0)
            item.push_back(placement.rotation);
         instances.push_back(std::move(item));
         return true;
      });
      if (!instances.empty())
         json["instances"] = std::move(instances);
      return json;
   }

   ordered_json cells(const CellArray &cells, const std::string &entry)
   {
      if (!m_blocks)
         return cellsText(cells, m_design.model);
      auto packed = packCells(cells, m_job);
      if (!packed) {
         if (!m_error)
            m_error = packed.error();
         return {};
      }
      m_blocks->emplace(entry, std::move(packed.value()));
      return {{"packed", entry}};
   }

   /// Back where it was, unless what it belonged to is gone.
   void putUnknown(ordered_json &json)
   {
      for (const auto &[pointer, value] : m_design.unknown.items()) {
         const ordered_json::json_pointer place(pointer);
         if (place.empty())
            continue;
         const auto parent = place.parent_pointer();
         if (json.contains(parent) && json.at(parent).is_object() && !json.contains(place))
            json[place] = value;
      }
   }

   const Design &m_design;
   Entries *m_blocks;
   const Job &m_job;
   std::optional<Error> m_error;
};

// --- reading
// -------------------------------------------------------------------------------------------------------

class DesignReader
{
public:
   DesignReader(const Entries &blocks, const Job &job) : m_blocks(blocks), m_job(job) {}

   Design read(const JsonPlace &top)
   {
      if (!top.object())
         return {};
      top.known({"diatom", "name", "lattice", "materials", "definitions", "assembly", "simulation", "parts",
                 "machine", "reference_meshes"});
      m_design.name = top.textOr("name", "");
      readLattice(top.at("lattice"));
      readMaterials(top.at("materials"));
      if (top.has("definitions"))
         readDefinitions(top.at("definitions"));
      if (top.has("assembly"))
         m_design.model.root = body(top.at("assembly"), {"cells", "instances"});
      if (top.has("simulation"))
         m_design.setup = readSetup(top.at("simulation"), m_design.model);
      if (top.has("parts"))
         readChoice(top.at("parts"), m_design.assembly.parts, m_design.assembly.partsValues);
      if (top.has("machine"))
         readChoice(top.at("machine"), m_design.assembly.machine, m_design.assembly.machineValues);
      if (top.has("reference_meshes"))
         m_design.referenceMeshes = readReferenceMeshes(top.at("reference_meshes"));
      m_design.unknown = std::move(top.log().unknown);
      return std::move(m_design);
   }

private:
   void readLattice(const JsonPlace &place)
   {
      auto &lattice = m_design.model.lattice;
      if (!place.object())
         return;
      place.known({"id", "values", "pitch_m", "aspect"});
      lattice.id = place.at("id").identifier();
      if (place.has("values"))
         lattice.values = place.at("values").values();
      lattice.pitch = place.numberOr("pitch_m", lattice.pitch, 1e-12, 1e6);
      if (place.has("aspect") && place.at("aspect").array(3))
         for (std::size_t a = 0; a < 3; ++a)
            lattice.aspect[a] = place.at("aspect").at(a).number(1e-6, 1e6);
   }

   void readMaterials(const JsonPlace &list)
   {
      std::vector<Material> materials;
      const auto count = list.size();
      if (count > 65535)
         list.mustBe("a list of at most 65535 materials");
      for (std::size_t i = 0; i < count && list.ok(); ++i) {
         const auto place = list.at(i);
         materials.push_back(place.json().is_null() ? Material() : readMaterial(place));
         const auto &id = materials.back().id;
         if (!id.empty() && !m_materials.emplace(id, static_cast<MaterialIndex>(i + 1)).second)
            place.at("id").fail(fmt::format("there are two materials \"{}\"; rename one", id));
      }
      m_design.model.materials = std::make_shared<const std::vector<Material>>(std::move(materials));
   }

   void readDefinitions(const JsonPlace &list)
   {
      const auto count = list.size();
      std::vector<std::shared_ptr<Definition>> made;
      std::vector<DefinitionId> numbers;
      for (std::size_t i = 0; i < count && list.ok(); ++i) {
         const auto place = list.at(i);
         if (!place.object())
            return;
         auto definition = std::make_shared<Definition>();
         definition->id = place.at("id").identifier();
         definition->name = place.textOr("name", definition->id);
         if (place.has("color"))
            definition->color = place.at("color").color();
         const auto number =
             place.has("number") ? place.at("number").integer(1, 0x7fffffff) : std::int64_t(i) + 1;
         if (!m_definitions.emplace(definition->id, static_cast<DefinitionId>(number)).second)
            place.at("id").fail(fmt::format("there are two composites \"{}\"; rename one", definition->id));
         if (!m_design.model.definitions.emplace(static_cast<DefinitionId>(number), definition).second)
            place.fail(fmt::format("two composites have number {}; remove one of the numbers", number));
         made.push_back(std::move(definition));
         numbers.push_back(static_cast<DefinitionId>(number));
      }
      for (std::size_t i = 0; i < made.size() && list.ok(); ++i) {
         m_current = numbers[i];
         made[i]->body = body(list.at(i), {"id", "name", "color", "number", "cells", "instances"});
      }
      m_current = 0;
      refuseCycles(list);
   }

   Body body(const JsonPlace &place, std::initializer_list<std::string_view> keys)
   {
      Body body;
      if (!place.object())
         return body;
      place.known(keys);
      if (place.has("cells"))
         body.cells = cells(place.at("cells"));
      if (place.has("instances")) {
         const auto list = place.at("instances");
         const auto count = list.size();
         for (std::size_t i = 0; i < count && list.ok(); ++i)
            addInstance(body, list.at(i));
      }
      return body;
   }

   void addInstance(Body &body, const JsonPlace &place)
   {
      const auto n = place.size();
      if (n != 2 && n != 3) {
         place.mustBe("[composite, [x, y, z]] or [composite, [x, y, z], rotation]");
         return;
      }
      const auto id = place.at(0).text();
      const auto found = m_definitions.find(id);
      if (found == m_definitions.end()) {
         place.fail(fmt::format("there is no composite \"{}\"; add it to /definitions or name another", id));
         return;
      }
      Placement placement{found->second, place.at(1).index(), 0};
      if (n == 3)
         placement.rotation = static_cast<std::uint8_t>(place.at(2).integer(0, 255));
      if (!body.instances.insert(placement))
         place.fail("the same composite is placed twice at one index; remove one");
      if (m_current != 0)
         m_uses[m_current].push_back(placement.definition);
   }

   CellArray cells(const JsonPlace &place)
   {
      if (place.json().is_array())
         return readCells(place, m_materials, m_budget);
      if (!place.object())
         return {};
      const auto name = place.at("packed").text();
      const auto block = m_blocks.find(name);
      if (block == m_blocks.end()) {
         place.fail(fmt::format("the packed cells \"{}\" are not in the file; restore it from a copy", name));
         return {};
      }
      auto cells = unpackCells(block->second, m_design.model.materials->size(), m_budget, m_job);
      if (!cells) {
         place.fail(fmt::format("the packed cells \"{}\" cannot be read: {}; restore the file from a copy",
                                name, cells.error().message));
         return {};
      }
      const auto counts = cells->countByMaterial();
      for (std::size_t m = 1; m < counts.size(); ++m)
         if (counts[m] > 0 && (*m_design.model.materials)[m - 1].id.empty())
            place.fail(fmt::format(
                "the packed cells \"{}\" use material {}, which was removed; restore the file from a copy",
                name, m));
      return std::move(cells.value());
   }

   /// Takes away definitions whose own instances are all taken away, until none is left; what stays is in a
   /// circle.
   void refuseCycles(const JsonPlace &list)
   {
      std::map<DefinitionId, std::size_t> open;
      std::map<DefinitionId, std::vector<DefinitionId>> usedBy;
      for (auto &[user, used] : m_uses) {
         std::sort(used.begin(), used.end());
         used.erase(std::unique(used.begin(), used.end()), used.end());
         open[user] = used.size();
         for (const auto one : used)
            usedBy[one].push_back(user);
      }
      std::vector<std::pair<DefinitionId, int>> ready;
      for (const auto &[number, definition] : m_design.model.definitions)
         if (!m_uses.contains(number))
            ready.emplace_back(number, 1);
      std::map<DefinitionId, int> depth;
      for (std::size_t next = 0; next < ready.size(); ++next) {
         const auto [number, level] = ready[next];
         if (level > kMostLevels)
            list.fail(fmt::format("composites nest deeper than {} levels; flatten some", kMostLevels));
         for (const auto user : usedBy[number]) {
            depth[user] = std::max(depth[user], level + 1);
            if (--open[user] == 0) {
               ready.emplace_back(user, depth[user]);
               open.erase(user);
            }
         }
      }
      if (!open.empty())
         list.fail(fmt::format("composite \"{}\" contains itself; take it out of what it is made of",
                               m_design.model.definition(open.begin()->first)->id));
   }

   static void readChoice(const JsonPlace &place, std::string &id, Values &values)
   {
      if (!place.object())
         return;
      place.known({"id", "values"});
      id = place.textOr("id", "");
      if (!id.empty() && !isIdentifier(id))
         place.at("id").mustBe("an id of letters, digits, '_', '.' and '-'");
      if (place.has("values"))
         values = place.at("values").values();
   }

   static constexpr int kMostLevels = 200; // walks over the hierarchy recurse

   const Entries &m_blocks;
   const Job &m_job;
   Design m_design;
   MaterialNames m_materials;
   std::map<std::string, DefinitionId> m_definitions;
   std::map<DefinitionId, std::vector<DefinitionId>> m_uses;
   DefinitionId m_current = 0;
   CellBudget m_budget;
};

} // namespace

Result<ordered_json> designJson(const Design &design, Entries *blocks, const Job &job)
{
   return Writer(design, blocks, job).write();
}

Design readDesignJson(const nlohmann::json &document, const Entries &blocks, ReadLog &log, const Job &job)
{
   return DesignReader(blocks, job).read(JsonPlace(document, log));
}

} // namespace diatom
