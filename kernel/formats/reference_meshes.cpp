#include "formats/reference_meshes.h"

#include "io/mesh_read.h"

#include <fmt/format.h>

namespace diatom {

Result<LoadedReferences> loadReferenceMeshes(const std::vector<ReferenceMesh> &references, const Job &job)
{
   LoadedReferences loaded;
   for (const ReferenceMesh &reference : references) {
      if (!reference.shown)
         continue;
      const double unit = reference.unit > 0 ? reference.unit : customaryUnit(reference.file);
      auto read = readMesh(reference.file, unit, job);
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
