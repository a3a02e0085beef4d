#include "formats/earlier_programs.h"

#include "formats/dmdesign_names.h"
#include "formats/write_dense.h"
#include "scene/where.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

namespace diatom {

namespace {

using Json = nlohmann::ordered_json;

class DmdesignWriter
{
public:
   DmdesignWriter(const Design &design, const Hierarchy &hierarchy, std::vector<std::string> &notes,
                  const Job &job)
       : m_model(design.model), m_lattice(hierarchy.lattice()), m_notes(notes), m_job(job)
   {}

   Result<std::string> run()
   {
      Json assembly;
      fail(putLattice(assembly));
      if (!m_error)
         putBody(m_model.root, assembly);
      Json materials = Json::object();
      putMaterials(materials);
      for (const auto &[number, definition] : m_model.definitions)
         if (!m_error)
            putComposite(*definition, materials);
      if (m_job.cancelled())
         return Error{ErrorCode::cancelled, "writing was cancelled"};
      if (m_error)
         return *m_error;
      m_notes.push_back("DMDesign keeps cells, composites and colours: the simulation and what materials are "
                        "like are lost");
      const Json file{{"assembly", std::move(assembly)}, {"materials", std::move(materials)}};
      return file.dump(1, '\t') + "\n";
   }

private:
   void fail(const Status &status)
   {
      if (!status && !m_error)
         m_error = status.error();
   }

   Status putLattice(Json &assembly)
   {
      const LatticeSpec &spec = m_model.lattice;
      const auto *found =
          std::find_if(dmdesign::kLattices.begin(), dmdesign::kLattices.end(), [&](const auto &name) {
             return spec.id == std::string("org.diatom_cad.lattice.") + name.id;
          });
      if (found == dmdesign::kLattices.end())
         return Error{ErrorCode::unsupported,
                      fmt::format("DMDesign has no lattice {}; export a mesh instead", spec.id)};
      std::string application = "default";
      if (m_lattice.hasSupercells()) {
         const auto height = spec.values.find("height");
         const double value = height == spec.values.end() ? 1.28 : std::get<double>(height->second);
         for (const auto &[name, known] : dmdesign::kHeights)
            if (value == known)
               application = name;
         if (application == "default" && value != 1)
            return Error{
                ErrorCode::unsupported,
                fmt::format("DMDesign has no bricks of height {}; choose 1.28, 1.17, 1.08 or 1", value)};
      }
      const auto unit = std::find_if(dmdesign::kUnits.begin() + 1, dmdesign::kUnits.end(),
                                     [&](const auto &known) { return spec.pitch >= 0.1 * known.second; });
      const auto &[name, metres] = unit == dmdesign::kUnits.end() ? dmdesign::kUnits.back() : *unit;
      assembly["units"] = name;
      assembly["scale"] = spec.pitch / metres;
      assembly["cellType"] = found->cell;
      assembly["connectionType"] = found->connection;
      assembly["applicationType"] = application;
      assembly["partType"] = Json();
      if (!m_lattice.hasSupercells())
         assembly["aspectRatio"] = {{"x", found->pitch[0] * spec.aspect[0]},
                                    {"y", found->pitch[1] * spec.aspect[1]},
                                    {"z", found->pitch[2] * spec.aspect[2]}};
      else if (spec.aspect != std::array<double, 3>{1, 1, 1})
         m_notes.push_back("DMDesign does not stretch bricks: the aspect is lost");
      return {};
   }

   /// Cells, bricks and composites of a body at the index they start from.
   void putBody(const Body &body, Json &to)
   {
      Box bounds = body.cells.bounds();
      body.instances.visit([&](const Placement &placement) {
         bounds.extend(placement.origin);
         return true;
      });
      fail(DenseCells::check(bounds));
      if (m_error)
         return;
      DenseCells cells(bounds);
      std::uint64_t count = 0;
      body.cells.visit([&](Index i, Cell cell) {
         if (cell.orientation != 0)
            fail(Error{ErrorCode::unsupported,
                       fmt::format("the cell at {} is turned, which DMDesign's cells are not; turn it back",
                                   indexText(i))});
         if (cell.joins & Cell::kJoinsPrevious)
            return !m_error; // within a brick that began earlier
         Json &entry = cells.at(i);
         entry["materialID"] = m_model.material(cell.material).id;
         if (m_lattice.hasSupercells())
            entry["length"] = lengthAt(body, i);
         ++count;
         return !m_error && !m_job.cancelled();
      });
      body.instances.visit([&](const Placement &placement) {
         Json &entry = cells.at(placement.origin);
         const std::string &id = m_model.definition(placement.definition)->id;
         if (placement.rotation != 0 || !entry.is_null())
            fail(Error{ErrorCode::unsupported,
                       fmt::format("composite {} at {} {}", id, indexText(placement.origin),
                                   placement.rotation != 0
                                       ? "is turned, which DMDesign's are not; turn it back"
                                       : "begins where something else does; move it")});
         entry["materialID"] = id;
         ++count;
         return !m_error;
      });
      to["numCells"] = count;
      std::move(cells).put(to);
   }

   std::int32_t lengthAt(const Body &body, Index i) const
   {
      std::int32_t length = 1;
      while (body.cells.at(i).joins & Cell::kJoinsNext) {
         i = i + m_lattice.supercellStep(m_lattice.site(i));
         ++length;
      }
      return length;
   }

   static std::string colorText(const std::array<std::uint8_t, 3> &color)
   {
      return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
   }

   void putMaterials(Json &materials) const
   {
      for (const Material &material : *m_model.materials) {
         if (material.id.empty())
            continue;
         Json properties = Json::object();
         if (material.role != ElectricalRole::insulator)
            properties["conductive"] = true;
         materials[material.id] = {{"name", material.name.empty() ? material.id : material.name},
                                   {"color", colorText(material.color)},
                                   {"altColor", colorText(material.color)},
                                   {"noDelete", false},
                                   {"properties", std::move(properties)}};
      }
   }

   void putComposite(const Definition &definition, Json &materials)
   {
      Json entry{{"name", definition.name.empty() ? definition.id : definition.name},
                 {"color", colorText(definition.color)},
                 {"altColor", colorText(definition.color)},
                 {"noDelete", false},
                 {"properties", Json::object()}};
      putBody(definition.body, entry);
      std::set<std::string> own, composites;
      definition.body.cells.visit([&](Index, Cell cell) {
         own.insert(m_model.material(cell.material).id);
         return true;
      });
      definition.body.instances.visit([&](const Placement &placement) {
         composites.insert(m_model.definition(placement.definition)->id);
         return true;
      });
      entry["elementaryChildren"] = own;
      entry["compositeChildren"] = composites;
      entry["isComposite"] = true;
      materials[definition.id] = std::move(entry);
   }

   const Model &m_model;
   const Lattice &m_lattice;
   std::vector<std::string> &m_notes;
   const Job &m_job;
   std::optional<Error> m_error;
};

} // namespace

Result<std::string> writeDmdesign(const Design &design, const Hierarchy &hierarchy,
                                  std::vector<std::string> &notes, const Job &job)
{
   return DmdesignWriter(design, hierarchy, notes, job).run();
}

} // namespace diatom
