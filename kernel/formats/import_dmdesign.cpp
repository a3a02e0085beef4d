// DMDesign's assemblies and composite definitions, with the rules of its deployed version.
#include "document/cell_text.h"
#include "formats/dmdesign_names.h"
#include "formats/importers.h"

#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace diatom {

namespace {

using dmdesign::kHeights, dmdesign::kLattices, dmdesign::kUnits;

constexpr int kLongestBrick = 100'000;

/// A composite is kept in up to two versions: as drawn, for even heights, and turned, for odd ones. The
/// program turned a composite at an odd height by -90 degrees about z, so that its bricks follow the layers
/// they come to lie in. Here the turned version is a definition of its own, one layer higher inside and
/// placed one layer lower, so that every placement is upright and at an even height.
struct Composite
{
   DefinitionId even = 0, odd = 0;
};

Index turned(Index i) { return {i.y, -i.x, i.z}; }

class DmdesignImport
{
public:
   DmdesignImport(ReadLog &log, const Job &job) : m_log(log), m_job(job) {}

   Opened read(const JsonPlace &top)
   {
      m_opened.format = "dmdesign";
      top.known({"assembly", "materials"});
      if (top.has("assembly"))
         readLattice(top.at("assembly"));
      const auto materials = top.at("materials");
      if (top.has("materials") && materials.object())
         readMaterials(materials);
      m_definitions = &materials;
      for (const auto &id : m_places)
         if (m_log.ok())
            define(id, false);
      if (top.has("assembly") && m_log.ok())
         readAssembly(top.at("assembly"));
      return std::move(m_opened);
   }

private:
   void note(std::string text) { m_opened.notes.push_back(std::move(text)); }
   Model &model() { return m_opened.design.model; }

   void readLattice(const JsonPlace &assembly)
   {
      if (!assembly.object())
         return;
      assembly.known({"cellsMin", "cellsMax", "numCells", "units", "scale", "cellType", "connectionType",
                      "applicationType", "latticeType", "partType", "aspectRatio", "denseCellsMin",
                      "overlapDetected", "cellSeparation", "sparseCells"});
      const auto cell = assembly.textOr("cellType", "cube"),
                 connection = assembly.textOr("connectionType", "face");
      const auto *found =
          std::find_if(std::begin(kLattices), std::end(kLattices), [&](const dmdesign::LatticeName &name) {
             return cell == name.cell && connection == name.connection;
          });
      if (found == std::end(kLattices)) {
         assembly.fail(
             fmt::format("there is no lattice of cellType \"{}\" with connectionType \"{}\"; correct them",
                         cell, connection));
         return;
      }
      m_gik = connection == "gik";
      model().lattice.id = std::string("org.diatom_cad.lattice.") + found->id;
      double unit = 1e-3;
      if (assembly.has("units"))
         unit = kUnits[assembly.at("units").word({"inches", "mm", "um", "nm"})].second;
      model().lattice.pitch = unit * assembly.numberOr("scale", 1, 1e-6, 1e6);
      if (m_gik)
         model().lattice.values["height"] = height(assembly);
      else if (assembly.has("aspectRatio"))
         readAspect(assembly.at("aspectRatio"), found->pitch);
   }

   /// The program wrote the distances between sites and scaled them alone; here cells stretch along, so that
   /// they still touch.
   void readAspect(const JsonPlace &place, const std::array<double, 3> &pitch)
   {
      constexpr const char *kAxes[] = {"x", "y", "z"};
      bool stretched = false;
      for (std::size_t k = 0; k < 3 && place.object() && place.ok(); ++k) {
         const double ratio = place.at(kAxes[k]).number(1e-3 * pitch[k], 1e3 * pitch[k]) / pitch[k];
         if (std::abs(ratio - 1) > 1e-4) { // the program shows four digits
            model().lattice.aspect[k] = ratio;
            stretched = true;
         }
      }
      if (stretched)
         note("/assembly/aspectRatio is not the lattice's own: cells are stretched with their distances");
   }

   static double height(const JsonPlace &assembly)
   {
      const auto application = assembly.textOr("applicationType", assembly.textOr("latticeType", ""));
      for (const auto &[name, value] : kHeights)
         if (application == name)
            return value;
      return 1;
   }

   void readMaterials(const JsonPlace &materials)
   {
      for (const auto &[id, value] : materials.json().items()) {
         const auto place = materials.at(id);
         if (id == "deleteMaterial" || !m_log.ok() || !place.object())
            continue;
         if (place.has("sparseCells")) {
            m_places.insert(id);
            continue;
         }
         place.known({"name", "color", "altColor", "id", "noDelete", "properties"});
         Material material;
         material.id = isIdentifier(id) ? id : fmt::format("material{}", m_materials.size() + 1);
         material.name = place.textOr("name", id);
         if (place.has("altColor") || place.has("color"))
            material.color = place.at(place.has("altColor") ? "altColor" : "color").color();
         const auto properties = place.at("properties");
         properties.known({"conductive"});
         if (properties.booleanOr("conductive", false))
            material.role = ElectricalRole::conductor;
         addMaterial(id, std::move(material));
      }
      if (!m_materials.empty())
         note("materials: the file has no mechanical properties; density 1000 kg/m3 and Young's modulus 1 "
              "MPa stand in for them");
   }

   MaterialIndex addMaterial(const std::string &id, Material material)
   {
      const auto added = model().setMaterial(std::move(material));
      if (!added) {
         if (!m_log.error)
            m_log.error = added.error();
         return 0;
      }
      m_materials.emplace(id, *added);
      return *added;
   }

   /// Makes the version of a composite for even or odd heights, what it contains first.
   DefinitionId define(const std::string &id, bool odd)
   {
      auto &made = odd ? m_composites[id].odd : m_composites[id].even;
      if (made != 0)
         return made;
      const auto place = m_definitions->at(id);
      if (!m_open.insert({id, odd}).second || m_open.size() > kMostLevels) {
         fault(id, m_open.size() > kMostLevels ? "nests too deep; flatten it"
                                               : "contains itself; take it out of its own cells");
         return 0;
      }
      Definition definition;
      definition.id = (isIdentifier(id) ? id : fmt::format("composite{}", model().definitions.size() + 1)) +
                      (odd ? "_odd" : "");
      if (!odd) {
         place.known({"name", "color", "altColor", "id", "noDelete", "properties", "sparseCells", "cellsMin",
                      "cellsMax", "dimensions", "origin", "numCells", "elementaryChildren",
                      "compositeChildren", "isComposite"});
      }
      definition.name = place.textOr("name", id) + (odd ? " (turned)" : "");
      if (place.has("altColor") || place.has("color"))
         definition.color = place.at(place.has("altColor") ? "altColor" : "color").color();
      readBody(place, definition.body, id, odd);
      m_open.erase({id, odd});
      if (!m_log.ok())
         return 0;
      const auto added = model().setDefinition(std::move(definition));
      if (!added) {
         fault(id, added.error().message);
         return 0;
      }
      made = *added;
      return made;
   }

   void fault(const std::string &id, std::string_view problem)
   {
      if (!m_log.error)
         m_log.error =
             Error{ErrorCode::unreadable, fmt::format("{}: /materials/{}: {}", m_log.name, id, problem)};
   }

   void readBody(const JsonPlace &place, Body &body, const std::string &owner, bool odd)
   {
      const Index origin = place.has("cellsMin") ? readXyz(place.at("cellsMin")) : Index{};
      visitDense(place.at("sparseCells"), origin, [&](Index i, const JsonPlace &element) {
         if (m_job.cancelled())
            return;
         element.known({"materialID", "materialName", "length"});
         const auto id = element.at(element.has("materialID") ? "materialID" : "materialName").text();
         if (m_places.contains(id))
            putComposite(body, id, i, odd, owner);
         else
            putBrick(body, id, i, element, odd);
      });
   }

   void putComposite(Body &body, const std::string &id, Index i, bool ownerOdd, const std::string &owner)
   {
      Index at = ownerOdd ? turned(i) + Index{0, 0, 1} : i;
      const bool odd = m_gik && floorMod(at.z, 2) != 0;
      const auto definition = define(id, odd);
      if (odd)
         at.z -= 1;
      if (definition != 0 && inRange(at) && !body.instances.insert({definition, at, 0}))
         fault(owner, fmt::format("composite \"{}\" is placed twice at one index; remove one", id));
   }

   void putBrick(Body &body, const std::string &id, Index i, const JsonPlace &element, bool odd)
   {
      auto found = m_materials.find(id);
      if (found == m_materials.end()) {
         Material material;
         material.id = isIdentifier(id) ? id : fmt::format("material{}", m_materials.size() + 1);
         material.name = id;
         note(fmt::format("material \"{}\" is not defined in the file; it was added with standard properties",
                          id));
         addMaterial(id, std::move(material));
         found = m_materials.find(id);
         if (found == m_materials.end())
            return;
      }
      const auto length = element.has("length")
                              ? static_cast<std::int32_t>(element.at("length").integer(1, kLongestBrick))
                              : 1;
      // Deployed rule: along y in even layers, along x in odd ones; turned by -90 degrees an x brick runs
      // towards -y.
      const Index along = floorMod(i.z, 2) == 0 ? Index{0, 1, 0} : Index{1, 0, 0};
      Index first = odd ? turned(i) + Index{0, 0, 1} : i;
      Index step = odd ? turned(along) : along;
      if (step.y < 0) {
         first = first + step * (length - 1);
         step = step * -1;
      }
      for (std::int32_t k = 0; k < length && element.ok(); ++k) {
         const Index at = first + step * k;
         const auto joins =
             m_gik ? (k > 0 ? Cell::kJoinsPrevious : 0) | (k + 1 < length ? Cell::kJoinsNext : 0) : 0;
         if (!inRange(at) || !m_budget.take({at, at}))
            element.fail("the brick lies outside what a document may hold; make it shorter");
         else if (!body.cells.at(at).empty())
            element.fail(fmt::format("two bricks overlap at [{}, {}, {}]; remove one", at.x, at.y, at.z));
         else
            body.cells.set(at, {found->second, 0, static_cast<std::uint8_t>(joins)});
      }
   }

   void readAssembly(const JsonPlace &assembly)
   {
      if (assembly.has("sparseCells"))
         readBody(assembly, model().root, "", false);
      const auto count = static_cast<double>(model().root.cells.count() + model().root.instances.count());
      if (count == 0 && !model().definitions.empty())
         note("the assembly is empty: the file defines composites only; place one to see it");
   }

   static constexpr std::size_t kMostLevels = 100;

   ReadLog &m_log;
   const Job &m_job;
   Opened m_opened;
   bool m_gik = false;
   const JsonPlace *m_definitions = nullptr; // /materials
   std::set<std::string> m_places;           // ids of composites
   MaterialNames m_materials;                // by the file's id
   std::map<std::string, Composite> m_composites;
   std::set<std::pair<std::string, bool>> m_open; // being defined
   CellBudget m_budget;
};

} // namespace

Opened importDmdesign(const nlohmann::json &file, ReadLog &log, const Job &job)
{
   return DmdesignImport(log, job).read(JsonPlace(file, log));
}

} // namespace diatom
