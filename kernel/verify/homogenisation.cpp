// Form "homogenisation": blocks of two materials between rigid plates, which move against each other in six
// ways.
#include "verify/forms.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace diatom {

namespace {

using nlohmann::json;

/// Part of the pitch, and angle: what it misses is a small part of it.
constexpr double kAmplitude = 1e-7;

/// Letters by layer of a pattern like "material by x layer: SFSFS", and widths like [5, 3, 1, 3, 5].
std::string layersOf(const std::string &pattern)
{
   const std::string words = "by x layer: ";
   const auto at = pattern.find(words);
   return at == std::string::npos ? "" : pattern.substr(at + words.size());
}

std::vector<int> widthsOf(const std::string &pattern)
{
   const auto begin = pattern.find('['), end = pattern.find(']');
   if (begin == std::string::npos || end == std::string::npos)
      return {};
   const json list = json::parse(pattern.substr(begin, end - begin + 1), nullptr, false);
   return list.is_array() ? list.get<std::vector<int>>() : std::vector<int>{};
}

class Primitive
{
public:
   Primitive(const Case &one, const json &primitive, const Bench &bench);

   /// 2 energy / amplitude^2 for "axial", "shear1", "shear2", "torsion", "bend1" and "bend2" across the faces
   /// normal to an axis; the plates hold the centres of the outer cells.
   Result<double> stiffness(const std::string &mode, int axis, const char *model) const;
   double mass() const { return m_mass; }
   const Vec3 &inertia() const { return m_inertia; }

private:
   Vec3 centre() const { return 0.5 * (m_edge - 1) * m_pitch * Vec3::Ones(); }

   const Bench &m_bench;
   double m_pitch, m_mass = 0;
   int m_edge;
   Vec3 m_inertia = Vec3::Zero();
   CaseScene m_scene;
   std::vector<Index> m_cells;
};

Primitive::Primitive(const Case &one, const json &primitive, const Bench &bench)
    : m_bench(bench), m_pitch(one.content.at("lattice").at("pitch")),
      m_edge(one.content.at("lattice").at("N")), m_scene(m_pitch)
{
   std::map<char, MaterialIndex> materials;
   std::map<char, double> density;
   for (const auto &[name, material] : one.content.at("materials").items()) {
      materials[name.at(0)] = m_scene.materialOf(material);
      density[name.at(0)] = one.content.at("density").at(name);
   }
   const auto pattern = primitive.at("pattern").get<std::string>();
   const std::string layers = layersOf(pattern);
   const std::vector<int> widths = widthsOf(pattern);
   const bool empty = pattern.find("rest empty") != std::string::npos;
   for (int x = 0; x < m_edge; ++x)
      for (int y = 0; y < m_edge; ++y)
         for (int z = 0; z < m_edge; ++z) {
            const auto layer = static_cast<std::size_t>(x);
            char letter = layer < layers.size() ? layers[layer] : 'S';
            if (layer < widths.size() && std::abs(2 * y - (m_edge - 1)) > widths[layer])
               letter = empty ? ' ' : 'F';
            if (letter == ' ')
               continue;
            m_cells.push_back({x, y, z});
            m_scene.cell({x, y, z}, materials.at(letter));
            const double mass = density.at(letter) * m_pitch * m_pitch * m_pitch;
            const Vec3 from = m_pitch * Vec3(x, y, z) - centre();
            m_mass += mass;
            m_inertia += mass * (from.squaredNorm() * Vec3::Ones() - from.cwiseAbs2()) +
                         mass * m_pitch * m_pitch / 6 * Vec3::Ones();
         }
}

Result<double> Primitive::stiffness(const std::string &mode, int axis, const char *model) const
{
   const int first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2; // the other axes, ascending
   Vec3 move = Vec3::Zero(), turn = Vec3::Zero();
   if (mode == "axial")
      move[axis] = 1;
   else if (mode == "torsion")
      turn[axis] = 1;
   else if (mode.starts_with("shear"))
      move[mode == "shear1" ? first : second] = 1;
   else
      turn[mode == "bend1" ? first : second] = 1;
   const double amplitude = kAmplitude * (move.norm() > 0 ? m_pitch : 1);
   CaseScene scene = m_scene;
   for (const Index &cell : m_cells) {
      const int place = axis == 0 ? cell.x : axis == 1 ? cell.y : cell.z;
      if (place != 0 && place != m_edge - 1)
         continue;
      const double half = place == 0 ? -0.5 * amplitude : 0.5 * amplitude;
      // About the middle of the plate itself.
      Vec3 arm = m_pitch * Vec3(cell.x, cell.y, cell.z) - centre();
      arm[axis] = 0;
      const Quat turned = turnBy(half * turn);
      scene.place(cell, half * move + (turned * arm - arm), turned);
   }
   const auto answer = balanceOf(m_bench, scene, modelValues(model));
   if (!answer)
      return answer.error();
   return 2 * answer->elasticEnergy() / (amplitude * amplitude);
}

} // namespace

Status answerHomogenisation(const Case &one, const Bench &bench, Findings &findings)
{
   const json &content = one.content;
   const double most = content.at("tol").at("lattice_rel");
   findings.skip("*_P2.*",
                 "its plates sit on the outer faces, joined by bonds of half a length, which a lattice of "
                 "whole cells does not have; P1 asks the same of the same block");
   findings.skip("*analytic_plane_sections*", "of plates on the outer faces, as P2");
   findings.skip("*conductance*", "of electronics, which a later form answers");
   findings.skip("*calculix*",
                 "CalculiX's own answer, which the case calls information: a block five elements wide of "
                 "beam bonds is not the solid (docs/models.md)");
   for (std::size_t p = 0; p < content.at("primitives").size(); ++p) {
      const json &primitive = content.at("primitives")[p];
      const Primitive block(one, primitive, bench);
      const std::string path = fmt::format("primitives.{}.", p);
      findings.compare(path + "mass", block.mass(), Tolerance::relative(most), "a sum over cells, no run");
      findings.compare(path + "inertia_about_centre", {block.inertia().data(), 3}, Tolerance::relative(most),
                       "a sum over cells, no run");
      for (const auto &[name, axis] : primitive.at("axes").items())
         for (const char *model : kModels) {
            const std::string key = std::string(model) + "_P1";
            for (const auto &[mode, value] : axis.at("values").at(key).items()) {
               const auto found = block.stiffness(mode, name == "y" ? 1 : name == "z" ? 2 : 0, model);
               const std::string own = fmt::format("{}axes.{}.values.{}.{}", path, name, key, mode);
               if (found)
                  findings.compare(own, *found, Tolerance::relative(most));
               else
                  findings.fail(own, found.error().message);
            }
         }
   }
   return {};
}

} // namespace diatom
