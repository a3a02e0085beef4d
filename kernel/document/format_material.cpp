// Materials between Material and JSON.
#include "document/format.h"
#include "scene/scene.h"

#include <fmt/format.h>

namespace diatom {

namespace {

using nlohmann::ordered_json;

constexpr const char *kPortNames[] = {"-x", "+x", "-y", "+y", "-z", "+z"};
constexpr std::uint8_t kAllPorts = 0x3f;
constexpr const char *kCellModels[] = {"bond", "block", "solid"};

/// Keys of the four kinds of constants, axial, shear, bending and torsion.
using ConstantKeys = std::array<const char *, 4>;
constexpr ConstantKeys kStiffnesses{"axial_N_m", "shear_N_m", "bending_N_m_rad", "torsion_N_m_rad"};
constexpr ConstantKeys kDampings{"axial_N_s_m", "shear_N_s_m", "bending_N_m_s_rad", "torsion_N_m_s_rad"};

ordered_json constantsJson(const BondConstants &constants, const ConstantKeys &keys)
{
   return {{keys[0], constants.axial},
           {keys[1], constants.shear},
           {keys[2], constants.bending},
           {keys[3], constants.torsion}};
}

std::array<double, 3> constants3(const JsonPlace &place)
{
   std::array<double, 3> values{};
   if (place.array(3))
      for (std::size_t a = 0; a < 3; ++a)
         values[a] = place.at(a).number(0);
   return values;
}

BondConstants readConstants(const JsonPlace &place, const ConstantKeys &keys)
{
   BondConstants constants;
   if (!place.object())
      return constants;
   place.known({keys[0], keys[1], keys[2], keys[3]});
   constants.axial = constants3(place.at(keys[0]));
   const auto shear = place.at(keys[1]);
   if (shear.array(3))
      for (std::size_t a = 0; a < 3; ++a)
         constants.shear[a] = constants3(shear.at(a));
   constants.bending = constants3(place.at(keys[2]));
   constants.torsion = constants3(place.at(keys[3]));
   return constants;
}

std::array<double, 3> readInertia(const JsonPlace &place)
{
   std::array<double, 3> inertia{1, 1, 1};
   if (place.array(3))
      for (std::size_t a = 0; a < 3; ++a)
         inertia[a] = place.at(a).number(1e-60, 1e60); // zero would make infinite frequencies
   return inertia;
}

ordered_json actuationJson(const Actuation &actuation)
{
   static constexpr const char *kModes[] = {"axial", "shear", "bending", "torsion"};
   return {{"mode", kModes[static_cast<std::size_t>(actuation.mode)]},
           {"axis", std::string(1, "xyz"[actuation.axis % 3])},
           {"strain_per_V", actuation.strainPerVolt},
           {"axis_from_wires", actuation.axisFromWires}};
}

Actuation readActuation(const JsonPlace &place)
{
   Actuation actuation;
   if (!place.object())
      return actuation;
   place.known({"mode", "axis", "strain_per_V", "axis_from_wires"});
   if (place.has("mode"))
      actuation.mode =
          static_cast<Actuation::Mode>(place.at("mode").word({"axial", "shear", "bending", "torsion"}));
   if (place.has("axis"))
      actuation.axis = static_cast<int>(place.at("axis").word({"x", "y", "z"}));
   actuation.strainPerVolt = place.numberOr("strain_per_V", 0, -10, 10);
   actuation.axisFromWires = place.booleanOr("axis_from_wires", false);
   return actuation;
}

std::map<std::string, double> readProperties(const JsonPlace &place)
{
   std::map<std::string, double> properties;
   if (!place.object())
      return properties;
   for (const auto &[name, value] : place.json().items()) {
      const auto property = place.at(name);
      if (!isIdentifier(name))
         property.fail("must be named by letters, digits and _ . - only");
      else if (isKnownProperty(name))
         property.fail(
             fmt::format("is a name that Diatom means something else by; choose another than {}", name));
      properties[name] = property.number();
   }
   return properties;
}

std::uint8_t readPorts(const JsonPlace &place)
{
   unsigned ports = 0;
   for (std::size_t i = 0; i < place.size() && place.ok(); ++i)
      ports |= 1U << place.at(i).word({"-x", "+x", "-y", "+y", "-z", "+z"});
   return static_cast<std::uint8_t>(ports);
}

} // namespace

ordered_json materialJson(const Material &material)
{
   static constexpr const char *kRoles[] = {"insulator", "conductor", "source", "actuator"};
   ordered_json json = {{"id", material.id},
                        {"name", material.name},
                        {"color", colorText(material.color)},
                        {"density_kg_m3", material.density},
                        {"youngs_modulus_Pa", material.youngsModulus},
                        {"poisson_ratio", material.poissonRatio},
                        {"damping_ratio", material.dampingRatio},
                        {"role", kRoles[static_cast<std::size_t>(material.role)]}};
   if (material.bonds)
      json["bonds"] = constantsJson(*material.bonds, kStiffnesses);
   if (material.dampings)
      json["dampings"] = constantsJson(*material.dampings, kDampings);
   if (material.inertia)
      json["inertia_kg_m2"] = *material.inertia;
   if (material.cellModel != CellModel::bond)
      json["cell_model"] = kCellModels[static_cast<std::size_t>(material.cellModel)];
   if (material.poissonCoupling)
      json["poisson_coupling"] = true;
   if (material.ports != kAllPorts) {
      auto ports = ordered_json::array();
      for (unsigned port = 0; port < 6; ++port)
         if (material.ports & (1U << port))
            ports.push_back(kPortNames[port]);
      json["ports"] = std::move(ports);
   }
   if (!material.properties.empty())
      json["properties"] = material.properties;
   if (material.actuation != Actuation{})
      json["actuation"] = actuationJson(material.actuation);
   return json;
}

Material readMaterial(const JsonPlace &place)
{
   Material material;
   if (!place.object())
      return material;
   place.known({"id", "name", "color", "density_kg_m3", "youngs_modulus_Pa", "poisson_ratio", "damping_ratio",
                "role", "bonds", "dampings", "inertia_kg_m2", "cell_model", "poisson_coupling", "ports",
                "actuation", "properties"});
   material.id = place.at("id").identifier();
   material.name = place.textOr("name", material.id);
   if (place.has("color"))
      material.color = place.at("color").color();
   // Zero mass or stiffness would make infinite frequencies and NaN.
   material.density = place.numberOr("density_kg_m3", material.density, 1e-9, 1e9);
   material.youngsModulus = place.numberOr("youngs_modulus_Pa", material.youngsModulus, 1e-6, 1e15);
   material.poissonRatio = place.numberOr("poisson_ratio", material.poissonRatio, -0.999, 0.4999);
   material.dampingRatio = place.numberOr("damping_ratio", 0, 0, 1000);
   if (place.has("bonds"))
      material.bonds = readConstants(place.at("bonds"), kStiffnesses);
   if (place.has("dampings"))
      material.dampings = readConstants(place.at("dampings"), kDampings);
   if (place.has("inertia_kg_m2"))
      material.inertia = readInertia(place.at("inertia_kg_m2"));
   if (place.has("cell_model"))
      material.cellModel = static_cast<CellModel>(place.at("cell_model").word({"bond", "block", "solid"}));
   material.poissonCoupling = place.booleanOr("poisson_coupling", false);
   if (place.has("role"))
      material.role = static_cast<ElectricalRole>(
          place.at("role").word({"insulator", "conductor", "source", "actuator"}));
   if (place.has("ports"))
      material.ports = readPorts(place.at("ports"));
   if (place.has("properties"))
      material.properties = readProperties(place.at("properties"));
   if (place.has("actuation"))
      material.actuation = readActuation(place.at("actuation"));
   return material;
}

} // namespace diatom
