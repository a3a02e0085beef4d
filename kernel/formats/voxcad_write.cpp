#include "formats/voxcad.h"

#include "core/base64.h"
#include "core/text.h"

#include <fmt/format.h>
#include <pugixml.hpp>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace diatom {

namespace {

std::string deflated(const std::string &bytes)
{
   auto size = compressBound(static_cast<uLong>(bytes.size()));
   std::string packed(size, '\0');
   compress(reinterpret_cast<Bytef *>(packed.data()), &size, reinterpret_cast<const Bytef *>(bytes.data()),
            static_cast<uLong>(bytes.size()));
   packed.resize(size);
   return packed;
}

void put(pugi::xml_node &to, const char *name, const std::string &text)
{
   to.append_child(name).text().set(text.c_str());
}
void put(pugi::xml_node &to, const char *name, double value) { put(to, name, numberText(value)); }

class VoxcadWriter
{
public:
   VoxcadWriter(const Design &design, const Hierarchy &hierarchy, std::vector<std::string> &notes,
                const Job &job)
       : m_design(design), m_hierarchy(hierarchy), m_notes(notes), m_job(job), m_bounds(hierarchy.bounds())
   {}

   Result<std::string> run(bool world)
   {
      if (const Status status = check(); !status)
         return status.error();
      pugi::xml_document document;
      auto declaration = document.append_child(pugi::node_declaration);
      declaration.append_attribute("version") = "1.0";
      declaration.append_attribute("encoding") = "UTF-8";
      pugi::xml_node top = document;
      if (world) {
         top = document.append_child("VXA");
         top.append_attribute("Version") = "1.0";
         putWorld(top);
      }
      auto vxc = top.append_child("VXC");
      vxc.append_attribute("Version") = "0.94";
      putLattice(vxc);
      putPalette(vxc);
      putStructure(vxc);
      if (m_job.cancelled())
         return Error{ErrorCode::cancelled, "writing was cancelled"};
      tellLosses(world);
      std::ostringstream text;
      document.save(text, " ");
      return std::move(text).str();
   }

private:
   Status check()
   {
      const LatticeSpec &lattice = m_design.model.lattice;
      if (lattice.id != LatticeSpec().id)
         return Error{
             ErrorCode::unsupported,
             fmt::format("VoxCAD knows cubes only, this design is on {}; export a mesh instead", lattice.id)};
      if (m_bounds.empty())
         return Error{ErrorCode::invalid, "there are no cells to write"};
      if (m_bounds.volume() > kMostVoxels)
         return Error{ErrorCode::invalid,
                      "VoxCAD's files hold every place of the box around the cells, which is too "
                      "large here; write a part of the design"};
      const auto counts = m_hierarchy.countByMaterial();
      m_number.assign(counts.size(), 0);
      int next = 1;
      for (std::size_t m = 1; m < counts.size(); ++m)
         if (counts[m] > 0) {
            if (next > 255)
               return Error{ErrorCode::unsupported, "VoxCAD has 255 materials, this design has more in use"};
            m_number[m] = static_cast<std::uint8_t>(next++);
         }
      return {};
   }

   void putLattice(pugi::xml_node &vxc) const
   {
      const LatticeSpec &spec = m_design.model.lattice;
      auto lattice = vxc.append_child("Lattice");
      put(lattice, "Lattice_Dim", spec.pitch);
      put(lattice, "X_Dim_Adj", spec.aspect[0]);
      put(lattice, "Y_Dim_Adj", spec.aspect[1]);
      put(lattice, "Z_Dim_Adj", spec.aspect[2]);
      for (const char *offset : {"X_Line_Offset", "Y_Line_Offset", "X_Layer_Offset", "Y_Layer_Offset"})
         put(lattice, offset, 0);
      auto voxel = vxc.append_child("Voxel");
      put(voxel, "Vox_Name", std::string("BOX"));
      for (const char *squeeze : {"X_Squeeze", "Y_Squeeze", "Z_Squeeze"})
         put(voxel, squeeze, 1);
   }

   void putPalette(pugi::xml_node &vxc) const
   {
      auto palette = vxc.append_child("Palette");
      for (std::size_t m = 1; m < m_number.size(); ++m) {
         if (m_number[m] == 0)
            continue;
         const Material &material = m_design.model.material(static_cast<MaterialIndex>(m));
         auto entry = palette.append_child("Material");
         entry.append_attribute("ID") = static_cast<unsigned>(m_number[m]);
         put(entry, "MatType", 0);
         put(entry, "Name", material.name.empty() ? material.id : material.name);
         auto display = entry.append_child("Display");
         put(display, "Red", material.color[0] / 255.0);
         put(display, "Green", material.color[1] / 255.0);
         put(display, "Blue", material.color[2] / 255.0);
         put(display, "Alpha", 1);
         auto mechanics = entry.append_child("Mechanical");
         put(mechanics, "MatModel", 0);
         put(mechanics, "Elastic_Mod", material.youngsModulus);
         put(mechanics, "Density", material.density);
         put(mechanics, "Poissons_Ratio", material.poissonRatio);
         put(mechanics, "CTE", 0);
         put(mechanics, "uStatic", m_design.setup.ground.friction);
         put(mechanics, "uDynamic", m_design.setup.ground.friction);
      }
   }

   void putStructure(pugi::xml_node &vxc) const
   {
      const Index size = m_bounds.max - m_bounds.min + Index{1, 1, 1};
      auto structure = vxc.append_child("Structure");
      structure.append_attribute("Compression") = "ZLIB";
      put(structure, "X_Voxels", size.x);
      put(structure, "Y_Voxels", size.y);
      put(structure, "Z_Voxels", size.z);
      auto data = structure.append_child("Data");
      std::string layer;
      for (std::int32_t z = m_bounds.min.z; z <= m_bounds.max.z && !m_job.cancelled(); ++z) {
         layer.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), '\0');
         m_hierarchy.visit(
             {{m_bounds.min.x, m_bounds.min.y, z}, {m_bounds.max.x, m_bounds.max.y, z}},
             [&](Index i, Cell cell) {
                layer[static_cast<std::size_t>(i.y - m_bounds.min.y) * static_cast<std::size_t>(size.x) +
                      static_cast<std::size_t>(i.x - m_bounds.min.x)] =
                    static_cast<char>(m_number[cell.material]);
                return true;
             });
         data.append_child("Layer")
             .append_child(pugi::node_cdata)
             .set_value(toBase64(deflated(layer)).c_str());
         m_job.progress(double(z - m_bounds.min.z + 1) / size.z, "writing layers");
      }
   }

   void putWorld(pugi::xml_node &vxa)
   {
      const Setup &setup = m_design.setup;
      auto simulator = vxa.append_child("Simulator");
      double ratio = 0;
      for (std::size_t m = 1; m < m_number.size(); ++m)
         if (m_number[m] != 0)
            ratio = std::max(ratio, m_design.model.material(static_cast<MaterialIndex>(m)).dampingRatio);
      auto damping = simulator.append_child("Damping");
      put(damping, "BondDampingZ", ratio);
      auto stop = simulator.append_child("StopCondition");
      put(stop, "StopConditionType", setup.until > 0 ? 2 : 0);
      put(stop, "StopConditionValue", setup.until);
      auto environment = vxa.append_child("Environment");
      auto regions = environment.append_child("Fixed_Regions");
      put(regions, "NumFixed", 0);
      int fixed = 0;
      for (const Support &support : setup.supports)
         fixed += putRegion(regions, support) ? 1 : 0;
      regions.child("NumFixed").text().set(fixed);
      auto gravity = environment.append_child("Gravity");
      put(gravity, "GravEnabled", setup.gravity[2] != 0 ? 1 : 0);
      put(gravity, "GravAcc", setup.gravity[2]);
      put(gravity, "FloorEnabled", setup.ground.present ? 1 : 0);
      auto thermal = environment.append_child("Thermal");
      put(thermal, "TempEnabled", 0);
   }

   bool putRegion(pugi::xml_node &regions, const Support &support)
   {
      Box box;
      if (const auto *cell = std::get_if<Index>(&support.where))
         box = {*cell, *cell};
      else if (const auto *whole = std::get_if<Box>(&support.where))
         box = *whole;
      if (box.empty()) {
         m_notes.push_back("supports of a whole material are lost: VoxCAD holds boxes");
         return false;
      }
      const Index size = m_bounds.max - m_bounds.min + Index{1, 1, 1}, low = box.min - m_bounds.min,
                  side = box.max - box.min + Index{1, 1, 1};
      auto region = regions.append_child("FRegion");
      put(region, "PrimType", 0);
      put(region, "X", double(low.x) / size.x);
      put(region, "Y", double(low.y) / size.y);
      put(region, "Z", double(low.z) / size.z);
      put(region, "dX", double(side.x) / size.x);
      put(region, "dY", double(side.y) / size.y);
      put(region, "dZ", double(side.z) / size.z);
      put(region, "DOF_Fixed", support.fixed);
      return true;
   }

   void tellLosses(bool world)
   {
      const Model &model = m_design.model;
      const Setup &setup = m_design.setup;
      if (m_bounds.min != Index{})
         m_notes.push_back(fmt::format("VoxCAD counts from 0: cells were moved by {} {} {}", -m_bounds.min.x,
                                       -m_bounds.min.y, -m_bounds.min.z));
      if (!model.definitions.empty())
         m_notes.push_back("composites were written as plain cells");
      const bool more =
          !setup.drives.empty() || !setup.loads.empty() || !setup.starts.empty() || !setup.sources.empty();
      if (more || (!world && !setup.supports.empty()))
         m_notes.push_back(world ? "drives, loads, starts and sources are lost"
                                 : "supports and all else of the simulation are lost; .vxa keeps some of it");
      const double lowest = m_hierarchy.lattice().position(m_bounds.min).z() -
                            0.5 * model.lattice.pitch * model.lattice.aspect[2];
      if (world && setup.ground.present &&
          std::abs(setup.ground.height - lowest) > 1e-6 * model.lattice.pitch)
         m_notes.push_back("VoxCAD's floor lies right under the lowest cell: the ground was moved there");
      if (world && (setup.gravity[0] != 0 || setup.gravity[1] != 0))
         m_notes.push_back("gravity along x and y is lost: VoxCAD's points along z");
   }

   const Design &m_design;
   const Hierarchy &m_hierarchy;
   std::vector<std::string> &m_notes;
   const Job &m_job;
   Box m_bounds;
   std::vector<std::uint8_t> m_number; // per material
};

} // namespace

Result<std::string> writeVoxcad(const Design &design, const Hierarchy &hierarchy, bool world,
                                std::vector<std::string> &notes, const Job &job)
{
   return VoxcadWriter(design, hierarchy, notes, job).run(world);
}

} // namespace diatom
