#include "io/geometry.h"

#include "io/surface.h"

#include <fmt/format.h>

#include <map>
#include <utility>

namespace diatom {

namespace {

std::string nameOf(const Material &material) { return material.name.empty() ? material.id : material.name; }

/// Solids by the material that names them; 0 for one of several materials.
using Solids = std::map<MaterialIndex, SolidMesh>;

Result<Solids> solidsOfCells(const Hierarchy &hierarchy, const GeometryOptions &options, const Job &job)
{
   std::map<MaterialIndex, SolidBuilder> builders;
   const Status seen = visitSurface(
       hierarchy, options.material, options.apart,
       [&](const SurfaceFace &face) {
          builders[options.apart ? face.material : MaterialIndex{0}].face(face.corners, face.material);
       },
       job);
   if (!seen)
      return seen.error();
   Solids solids;
   for (auto &[material, builder] : builders) {
      auto solid = builder.finish();
      if (!solid)
         return solid.error();
      solids.emplace(material, *std::move(solid));
   }
   return solids;
}

/// A part's mesh, welded and a manifold.
Result<SolidMesh> solidOfPart(const PartMaker &maker, const Part &part, int detail, double pitch,
                              const Job &job)
{
   auto mesh = maker.mesh(part.type, part.length, detail, pitch, job);
   if (!mesh)
      return mesh.error();
   SolidBuilder builder;
   for (const auto &[a, b, c] : mesh->triangles) {
      const Vec3 corners[3] = {mesh->vertices[static_cast<std::size_t>(a)],
                               mesh->vertices[static_cast<std::size_t>(b)],
                               mesh->vertices[static_cast<std::size_t>(c)]};
      builder.face(corners, part.material);
   }
   return builder.finish();
}

void append(SolidMesh &all, const SolidMesh &one, const Part &part)
{
   const auto first = static_cast<std::uint32_t>(all.vertices.size());
   const Mat3 turn = part.orientation.toRotationMatrix();
   for (const Vec3 &vertex : one.vertices)
      all.vertices.push_back(part.position + turn * vertex);
   for (const auto &[a, b, c] : one.triangles)
      all.triangles.push_back({first + a, first + b, first + c});
   all.materials.insert(all.materials.end(), one.triangles.size(), part.material);
   all.edgeContacts += one.edgeContacts;
   all.vertexContacts += one.vertexContacts;
}

Result<Solids> solidsOfParts(const Hierarchy &hierarchy, const PartMaker &maker,
                             const GeometryOptions &options, Geometry &geometry, const Job &job)
{
   const auto parts = maker.decompose(hierarchy, job);
   if (!parts)
      return parts.error();
   const int detail = options.detail < 0 ? maker.details() - 1 : options.detail;
   std::map<std::pair<int, int>, SolidMesh> made;
   Solids solids;
   for (const Part &part : parts->parts) {
      if (options.material && part.material != *options.material)
         continue;
      if (job.cancelled())
         return Error{ErrorCode::cancelled, "the export was cancelled"};
      const std::pair key(part.type, part.length);
      auto found = made.find(key);
      if (found == made.end()) {
         auto solid = solidOfPart(maker, part, detail, hierarchy.lattice().spec().pitch, job);
         if (!solid)
            return Error{solid.error().code,
                         fmt::format("part {}: {}", parts->types[static_cast<std::size_t>(part.type)].id,
                                     solid.error().message)};
         found = made.emplace(key, *std::move(solid)).first;
      }
      SolidMesh &all = solids[options.apart ? part.material : MaterialIndex{0}];
      if (all.triangles.size() + found->second.triangles.size() > 0xffff'ffffu / 3)
         return Error{ErrorCode::invalid, "the parts have more triangles than a mesh with indices can count; "
                                          "export them by material, in less detail or as STL"};
      append(all, found->second, part);
      ++geometry.parts;
      geometry.cells += static_cast<std::uint64_t>(part.cells);
   }
   return solids;
}

/// A set of beams for each material, with the nodes they end at.
std::vector<BeamSet> beamsOf(const StrutGraph &graph, const GeometryOptions &options,
                             const Geometry &geometry)
{
   std::map<MaterialIndex, BeamSet> sets;
   std::map<std::pair<MaterialIndex, std::uint32_t>, std::uint32_t> numbers;
   for (const Strut &strut : graph.struts) {
      if (options.material && strut.material != *options.material)
         continue;
      BeamSet &set = sets[strut.material];
      std::array<std::uint32_t, 2> beam{strut.a, strut.b};
      for (std::uint32_t &node : beam) {
         const auto [found, added] =
             numbers.emplace(std::pair(strut.material, node), static_cast<std::uint32_t>(set.nodes.size()));
         if (added)
            set.nodes.push_back(graph.nodes[node]);
         node = found->second;
      }
      set.beams.push_back(beam);
   }
   std::vector<BeamSet> all;
   for (auto &[material, set] : sets) {
      set.name = nameOf(geometry.material(material));
      set.material = material;
      all.push_back(std::move(set));
   }
   return all;
}

Result<Solids> solidsOfStruts(const Hierarchy &hierarchy, const GeometryOptions &options, Geometry &geometry,
                              const Job &job)
{
   const auto graph = strutGraph(hierarchy, options.struts.connections, job);
   if (!graph)
      return graph.error();
   if (options.struts.beams) {
      const auto facts = strutFacts(*graph, options.struts, job);
      if (!facts)
         return facts.error();
      geometry.struts = *facts;
      geometry.beams = beamsOf(*graph, options, geometry);
      return Solids{};
   }
   auto solids = strutSolids(*graph, options.struts, options.apart || options.material.has_value(),
                             geometry.struts, job);
   if (solids && options.material)
      for (auto at = solids->begin(); at != solids->end();)
         at = at->first == *options.material ? std::next(at) : solids->erase(at);
   return solids;
}

Result<Solids> solidsOf(const Hierarchy &hierarchy, const PartMaker *maker, const GeometryOptions &options,
                        Geometry &geometry, const Job &job)
{
   switch (options.what) {
   case GeometryOptions::What::cells:
      return solidsOfCells(hierarchy, options, job);
   case GeometryOptions::What::parts:
      return solidsOfParts(hierarchy, *maker, options, geometry, job);
   case GeometryOptions::What::struts:
      break;
   }
   return solidsOfStruts(hierarchy, options, geometry, job);
}

Status checkOptions(const PartMaker *maker, const GeometryOptions &options)
{
   if (options.what != GeometryOptions::What::parts)
      return {};
   if (!maker)
      return Error{ErrorCode::usage, "an export of parts needs a parts plugin"};
   if (options.detail < -1 || options.detail >= maker->details())
      return Error{ErrorCode::usage, fmt::format("{} has no detail {}; there are 0 to {}", maker->id(),
                                                 options.detail, maker->details() - 1)};
   return {};
}

} // namespace

std::uint64_t Geometry::triangles() const
{
   std::uint64_t sum = 0;
   for (const Solid &solid : solids)
      sum += solid.mesh.triangles.size();
   return sum;
}

std::uint64_t Geometry::edgeContacts() const
{
   std::uint64_t sum = 0;
   for (const Solid &solid : solids)
      sum += solid.mesh.edgeContacts;
   return sum;
}

std::uint64_t Geometry::vertexContacts() const
{
   std::uint64_t sum = 0;
   for (const Solid &solid : solids)
      sum += solid.mesh.vertexContacts;
   return sum;
}

Result<Geometry> makeGeometry(const Hierarchy &hierarchy, const PartMaker *maker,
                              const GeometryOptions &options, const Job &job)
{
   if (const Status status = checkOptions(maker, options); !status)
      return status.error();
   Geometry geometry;
   geometry.materials = *hierarchy.model().materials;
   auto solids = solidsOf(hierarchy, maker, options, geometry, job);
   if (!solids)
      return solids.error();
   if (options.what != GeometryOptions::What::parts) {
      const auto counts = hierarchy.countByMaterial();
      for (std::size_t material = 1; material < counts.size(); ++material)
         if (!options.material || *options.material == material)
            geometry.cells += counts[material];
   }
   for (auto &[material, mesh] : *solids) {
      if (mesh.triangles.empty())
         continue;
      const MaterialIndex named = options.material ? *options.material : material;
      geometry.solids.push_back(
          {named == 0 ? "all" : nameOf(geometry.material(named)), named, std::move(mesh)});
   }
   return geometry;
}

} // namespace diatom
