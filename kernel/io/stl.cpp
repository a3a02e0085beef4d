#include "io/stl.h"

#include "io/solid_mesh.h"
#include "io/stl_file.h"
#include "io/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

namespace diatom {

namespace {

using Triangle = std::function<void(const Vec3 &, const Vec3 &, const Vec3 &)>;

/// An STL corner has 24 bits: beyond this many cell radii from the origin, corners of one cell begin to
/// coincide.
constexpr double kFarthest = 1 << 20;

Status checkOptions(const Hierarchy &hierarchy, const PartMaker *maker, const StlOptions &options)
{
   if (!(options.unit > 0) || !std::isfinite(options.unit))
      return Error{ErrorCode::usage, "the unit of an STL file must be a positive length"};
   if (options.what == StlOptions::What::parts) {
      if (!maker)
         return Error{ErrorCode::usage, "an export of parts needs a parts plugin"};
      if (options.detail < -1 || options.detail >= maker->details())
         return Error{ErrorCode::usage, fmt::format("{} has no detail {}; there are 0 to {}", maker->id(),
                                                    options.detail, maker->details() - 1)};
   }
   const Box bounds = hierarchy.bounds();
   if (bounds.empty())
      return {};
   double reach = 0;
   for (int corner = 0; corner < 8; ++corner) {
      const Index index{corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                        corner & 4 ? bounds.max.z : bounds.min.z};
      reach = std::max(reach, hierarchy.lattice().position(index).lpNorm<Eigen::Infinity>());
   }
   if (reach > kFarthest * hierarchy.lattice().radius())
      return Error{ErrorCode::invalid,
                   "the design reaches more than a million cells from the origin, where the single-precision "
                   "numbers of STL cannot tell the corners of a cell apart; move it nearer to the origin"};
   return {};
}

/// Cells that an export of this material covers.
std::uint64_t cellCount(const Hierarchy &hierarchy, std::optional<MaterialIndex> material)
{
   if (!material)
      return hierarchy.cells();
   const auto counts = hierarchy.countByMaterial();
   return *material < counts.size() ? counts[*material] : 0;
}

Status cellTriangles(const Hierarchy &hierarchy, const StlOptions &options, const Triangle &triangle,
                     const Job &job)
{
   std::vector<Vec3> corners;
   return visitSurface(
       hierarchy, options.material, false,
       [&](const SurfaceFace &face) {
          corners.assign(face.corners.begin(), face.corners.end());
          if (options.moved)
             std::transform(corners.begin(), corners.end(), corners.begin(), options.moved);
          for (std::size_t i = 2; i < corners.size(); ++i)
             triangle(corners[0], corners[i - 1], corners[i]);
       },
       job);
}

/// Meshes of the parts that occur, each made once.
class MeshCache
{
public:
   MeshCache(const PartMaker &maker, int detail, double pitch, const Job &job)
       : m_maker(maker), m_detail(detail < 0 ? maker.details() - 1 : detail), m_pitch(pitch), m_job(job)
   {}
   Result<const Mesh *> mesh(const Part &part)
   {
      const std::pair key(part.type, part.length);
      auto found = m_meshes.find(key);
      if (found == m_meshes.end()) {
         auto made = m_maker.mesh(part.type, part.length, m_detail, m_pitch, m_job);
         if (!made)
            return made.error();
         found = m_meshes.emplace(key, *std::move(made)).first;
      }
      return &found->second;
   }

private:
   const PartMaker &m_maker;
   int m_detail;
   double m_pitch;
   const Job &m_job;
   std::map<std::pair<int, int>, Mesh> m_meshes;
};

Status partTriangles(const Hierarchy &hierarchy, const PartMaker &maker, const Decomposition &parts,
                     const StlOptions &options, const Triangle &triangle, const Job &job)
{
   MeshCache cache(maker, options.detail, hierarchy.lattice().spec().pitch, job);
   std::vector<Vec3> world;
   for (std::size_t i = 0; i < parts.parts.size(); ++i) {
      const Part &part = parts.parts[i];
      if (i % 256 == 0) {
         if (job.cancelled())
            return Error{ErrorCode::cancelled, "the export was cancelled"};
         job.progress(static_cast<double>(i) / static_cast<double>(parts.parts.size()), "writing parts");
      }
      if (options.material && part.material != *options.material)
         continue;
      const auto mesh = cache.mesh(part);
      if (!mesh)
         return mesh.error();
      const Mat3 turn = part.orientation.toRotationMatrix();
      world.clear();
      for (const Vec3 &vertex : (*mesh)->vertices)
         world.push_back(part.position + turn * vertex);
      for (const auto &corners : (*mesh)->triangles)
         triangle(world[static_cast<std::size_t>(corners[0])], world[static_cast<std::size_t>(corners[1])],
                  world[static_cast<std::size_t>(corners[2])]);
   }
   return {};
}

/// Everything that several files of one export share.
struct Export
{
   const Hierarchy &hierarchy;
   const PartMaker *maker;
   const Decomposition &parts; // empty unless parts are exported
   const Job &job;

   Status triangles(const StlOptions &options, const Triangle &triangle) const
   {
      return options.what == StlOptions::What::cells
                 ? cellTriangles(hierarchy, options, triangle, job)
                 : partTriangles(hierarchy, *maker, parts, options, triangle, job);
   }

   Result<StlReport> write(const StlOptions &options, const std::filesystem::path &file) const
   {
      std::uint64_t known = 0;
      if (file == "-" && !options.ascii)
         if (const Status counted = triangles(options, [&](auto &&...) { ++known; }); !counted)
            return counted.error();
      StlFile out(file, options.ascii, options.unit, known);
      const Status drawn =
          triangles(options, [&](const Vec3 &a, const Vec3 &b, const Vec3 &c) { out.triangle(a, b, c); });
      if (!drawn)
         return drawn.error();
      if (const Status done = out.commit(); !done)
         return done.error();
      StlReport report{file, options.material, out.triangles(), out.bytes(), 0, 0, {}, {}};
      if (options.what == StlOptions::What::cells)
         report.cells = cellCount(hierarchy, options.material);
      if (options.what == StlOptions::What::cells && options.contacts) {
         const auto solid = cellSolid(hierarchy, options.material, job);
         if (!solid)
            return solid.error();
         report.edgeContacts = solid->edgeContacts;
         report.vertexContacts = solid->vertexContacts;
      }
      for (const Part &part : parts.parts)
         if (!options.material || part.material == *options.material) {
            ++report.parts;
            report.cells += static_cast<std::uint64_t>(part.cells);
         }
      return report;
   }
};

Result<Decomposition> decomposed(const Hierarchy &hierarchy, const PartMaker *maker,
                                 const StlOptions &options, const Job &job)
{
   if (const Status status = checkOptions(hierarchy, maker, options); !status)
      return status.error();
   if (options.what == StlOptions::What::cells)
      return Decomposition{};
   return maker->decompose(hierarchy, job);
}

} // namespace

Result<StlReport> writeStl(const Hierarchy &hierarchy, const PartMaker *maker, const StlOptions &options,
                           const std::filesystem::path &file, const Job &job)
{
   const auto parts = decomposed(hierarchy, maker, options, job);
   if (!parts)
      return parts.error();
   return Export{hierarchy, maker, *parts, job}.write(options, file);
}

Result<std::vector<StlReport>> writeStlByMaterial(const Hierarchy &hierarchy, const PartMaker *maker,
                                                  const StlOptions &options,
                                                  const std::filesystem::path &file, const Job &job)
{
   if (file == "-")
      return Error{ErrorCode::usage, "a file per material cannot go to standard output; give a file name"};
   const auto parts = decomposed(hierarchy, maker, options, job);
   if (!parts)
      return parts.error();
   const auto counts = hierarchy.countByMaterial();
   std::vector<StlReport> reports;
   for (std::size_t material = 1; material < counts.size(); ++material) {
      if (counts[material] == 0)
         continue;
      StlOptions one = options;
      one.material = static_cast<MaterialIndex>(material);
      auto name = file.stem().string() + "." + hierarchy.model().material(*one.material).id;
      name += file.has_extension() ? file.extension().string() : ".stl";
      auto report = Export{hierarchy, maker, *parts, job}.write(one, file.parent_path() / name);
      if (!report)
         return report.error();
      reports.push_back(*std::move(report));
   }
   return reports;
}

} // namespace diatom
