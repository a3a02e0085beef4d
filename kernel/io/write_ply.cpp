// PLY: binary, with colours.
#include "core/file.h"
#include "core/text.h"
#include "io/geometry_writers.h"

#include <fmt/format.h>

namespace diatom {

namespace {

std::string header(const Geometry &geometry, double unit)
{
   std::uint64_t vertices = 0;
   for (const Solid &solid : geometry.solids)
      vertices += solid.mesh.vertices.size();
   constexpr const char *kColour = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
   return fmt::format("ply\nformat binary_little_endian 1.0\ncomment Diatom, one unit is {} m\n"
                      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n{}"
                      "element face {}\nproperty list uchar int vertex_indices\n{}end_header\n",
                      numberText(unit), vertices, kColour, geometry.triangles(), kColour);
}

void putColour(std::string &to, const Material &material)
{
   for (const std::uint8_t part : material.color)
      to += static_cast<char>(part);
}

/// The material of the first triangle at each vertex.
std::vector<MaterialIndex> vertexMaterials(const SolidMesh &mesh)
{
   std::vector<MaterialIndex> first(mesh.vertices.size(), 0);
   for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t corner : mesh.triangles[t])
         if (first[corner] == 0)
            first[corner] = mesh.materials[t];
   return first;
}

} // namespace

Written writePly(const Geometry &geometry, double unit, const std::filesystem::path &file, const Job &job)
{
   std::uint64_t vertices = 0;
   for (const Solid &solid : geometry.solids)
      vertices += solid.mesh.vertices.size();
   if (vertices > 0x7fff'ffff)
      return Error{ErrorCode::unwritable, file.string() +
                                              ": more vertices than a PLY file's 32-bit indices can "
                                              "count; export it by material or as STL"};
   AtomicFile out(file);
   out.write(header(geometry, unit));
   std::string bytes;
   for (const Solid &solid : geometry.solids) {
      const auto materials = vertexMaterials(solid.mesh);
      for (std::size_t v = 0; v < solid.mesh.vertices.size(); ++v) {
         bytes.clear();
         for (int axis = 0; axis < 3; ++axis)
            putSingle(bytes, solid.mesh.vertices[v][axis] / unit);
         putColour(bytes, geometry.material(materials[v]));
         out.write(bytes);
      }
   }
   std::uint32_t first = 0;
   for (const Solid &solid : geometry.solids) {
      for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t) {
         if (t % 65536 == 0) {
            if (job.cancelled())
               return exportCancelled();
            job.progress(static_cast<double>(t) / static_cast<double>(solid.mesh.triangles.size()),
                         "writing " + solid.name);
         }
         bytes.assign(1, '\3');
         for (const std::uint32_t corner : solid.mesh.triangles[t])
            putWord(bytes, first + corner);
         putColour(bytes, geometry.material(solid.mesh.materials[t]));
         out.write(bytes);
      }
      first += static_cast<std::uint32_t>(solid.mesh.vertices.size());
   }
   if (const Status done = out.commit(); !done)
      return done.error();
   return out.written();
}

} // namespace diatom
