// Meshes of other programs in: STL, OBJ, PLY, 3MF, glTF and whatever else assimp reads.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "io/triangle_mesh.h"

#include <filesystem>
#include <string>
#include <vector>

namespace diatom {

struct MeshRead
{
   TriangleMesh mesh;
   std::string format;             // its suffix, lower case
   std::vector<std::string> notes; // what was left out
};

/// Whether this build can read meshes at all.
bool canReadMeshes();
/// Whether the suffix is one of a mesh format that is read.
bool isMeshFile(const std::filesystem::path &file);
/// Metres per unit of numbers in such a file: what the file says (3MF) or the format (glTF: 1), else
/// millimetres by custom.
double customaryUnit(const std::filesystem::path &file);

/// `unit` is metres per number in the file. Transformations of the file's scene are applied; points and lines
/// are left out. Refuses files without triangles, with numbers that are not finite, and larger than 4 GB.
Result<MeshRead> readMesh(const std::filesystem::path &file, double unit, const Job &job);

} // namespace diatom
