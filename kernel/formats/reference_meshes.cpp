#include "formats/reference_meshes.h"

#include "io/mesh_read.h"

#include <fmt/format.h>

namespace diatom {

Result<LoadedReferences> loadReferenceMeshes(const Design &design, const std::filesystem::path &folder,
                                             const Job &job)
{
   LoadedReferences loaded;
   for (const ReferenceMesh &reference : design.referenceMeshes) {
      if (!reference.shown)
         continue;
      const auto file = folder / reference.file; // an absolute path stays what it is
      const double unit = reference.unit > 0 ? reference.unit : customaryUnit(file);
      auto read = readMesh(file, unit, job);
      if (!read) {
         if (read.error().code == ErrorCode::cancelled)
            return read.error();
         loaded.notes.push_back(
             fmt::format("the reference mesh \"{}\" is not shown: {}", reference.name, read.error().message));
         continue;
      }
      for (Vec3 &vertex : read->mesh.vertices)
         vertex += reference.position;
      loaded.meshes.push_back(std::move(read->mesh));
   }
   return loaded;
}

} // namespace diatom
