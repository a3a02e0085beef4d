#include "gui/default_design.h"

#include "core/check.h"

namespace diatom::gui {

Design defaultDesign(const std::string &lattice)
{
   struct Row
   {
      const char *id, *name;
      double density, youngsModulus, poissonRatio, dampingRatio;
      ElectricalRole role;
      std::array<std::uint8_t, 3> color;
   };
   // Densities (kg/m3) and moduli (Pa) of typical stock: acrylic, silicone rubber, brass, fibre laminate, PZT
   // ceramic.
   static constexpr Row rows[] = {
       {"rigid", "Rigid", 1190, 3.2e9, 0.37, 0.01, ElectricalRole::insulator, {0x8f, 0x9d, 0xab}},
       {"flexure", "Flexure", 1100, 5e6, 0.45, 0.05, ElectricalRole::insulator, {0xe0, 0x8a, 0x3c}},
       {"conductor", "Conductor", 8500, 1.0e11, 0.34, 0.005, ElectricalRole::conductor, {0xd6, 0xb2, 0x3d}},
       {"insulator", "Insulator", 1850, 1.8e10, 0.14, 0.01, ElectricalRole::insulator, {0x5f, 0x8f, 0x6a}},
       {"actuator", "Actuator", 7800, 6.3e10, 0.31, 0.01, ElectricalRole::actuator, {0x7a, 0x5f, 0xb0}},
       {"source", "Source", 2000, 1.0e10, 0.3, 0.01, ElectricalRole::source, {0xc2, 0x4f, 0x55}}};
   Design design;
   design.model.lattice.id = lattice;
   for (const Row &row : rows) {
      Material material;
      material.id = row.id;
      material.name = row.name;
      material.color = row.color;
      material.density = row.density;
      material.youngsModulus = row.youngsModulus;
      material.poissonRatio = row.poissonRatio;
      material.dampingRatio = row.dampingRatio;
      material.role = row.role;
      if (row.role == ElectricalRole::actuator) {
         material.ports = 0x3; // terminals on its -x and +x faces
         material.actuation.strainPerVolt = 1e-3;
      }
      DIATOM_CHECK(design.model.setMaterial(material).ok());
   }
   return design;
}

} // namespace diatom::gui
