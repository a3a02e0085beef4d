#include "parts/part_list.h"

#include <map>
#include <tuple>

namespace diatom {

namespace {

/// By the divergence theorem, about a corner: no cancellation where a part lies far from its origin.
double volumeOf(const Mesh &mesh)
{
   double sixfold = 0;
   const Vec3 zero = mesh.vertices.front();
   const auto corner = [&](std::int32_t v) -> Vec3 {
      return mesh.vertices[static_cast<std::size_t>(v)] - zero;
   };
   for (const auto &[a, b, c] : mesh.triangles)
      sixfold += corner(a).dot(corner(b).cross(corner(c)));
   return sixfold / 6;
}

} // namespace

Result<std::vector<PartCount>> countParts(const PartMaker &maker, const Decomposition &parts,
                                          const Hierarchy &hierarchy, const Job &job)
{
   std::map<std::tuple<int, int, MaterialIndex>, std::int64_t> counts;
   for (const Part &part : parts.parts)
      ++counts[{part.type, part.length, part.material}];
   std::map<std::pair<int, int>, double> volumes;
   std::vector<PartCount> rows;
   for (const auto &[kind, count] : counts) {
      const auto &[type, length, material] = kind;
      auto known = volumes.find({type, length});
      if (known == volumes.end()) {
         const auto mesh =
             maker.mesh(type, length, maker.details() - 1, hierarchy.lattice().spec().pitch, job);
         if (!mesh)
            return mesh.error();
         known = volumes.emplace(std::pair(type, length), volumeOf(*mesh)).first;
      }
      const double mass = known->second * hierarchy.model().material(material).density;
      rows.push_back({type, length, material, count, known->second, mass});
   }
   return rows;
}

} // namespace diatom
