// What assimp, a reader that is not ours, finds in a file: meshes with their material's name and colour.
#pragma once

#include "support/mesh.h"

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace diatom::test {

struct ReadMesh
{
   std::string material;
   std::array<double, 3> colour{}; // as the file has it
   std::vector<Corner<float>> vertices;
   std::vector<std::array<std::uint32_t, 3>> triangles;
   std::vector<std::array<int, 3>> vertexColours; // 0 to 255, empty without

   std::vector<Triangle<float>> corners() const
   {
      std::vector<Triangle<float>> all;
      for (const auto &[a, b, c] : triangles)
         all.push_back({vertices[a], vertices[b], vertices[c]});
      return all;
   }
};

inline void readNode(const aiScene &scene, const aiNode &node, const aiMatrix4x4 &above,
                     std::vector<ReadMesh> &meshes)
{
   const aiMatrix4x4 here = above * node.mTransformation;
   for (unsigned m = 0; m < node.mNumMeshes; ++m) {
      const aiMesh &from = *scene.mMeshes[node.mMeshes[m]];
      ReadMesh mesh;
      for (unsigned v = 0; v < from.mNumVertices; ++v) {
         const aiVector3D at = here * from.mVertices[v];
         mesh.vertices.push_back({at.x, at.y, at.z});
         if (from.HasVertexColors(0)) {
            const aiColor4D &c = from.mColors[0][v];
            mesh.vertexColours.push_back(
                {int(std::lround(c.r * 255)), int(std::lround(c.g * 255)), int(std::lround(c.b * 255))});
         }
      }
      for (unsigned f = 0; f < from.mNumFaces; ++f)
         if (from.mFaces[f].mNumIndices == 3)
            mesh.triangles.push_back(
                {from.mFaces[f].mIndices[0], from.mFaces[f].mIndices[1], from.mFaces[f].mIndices[2]});
      const aiMaterial &material = *scene.mMaterials[from.mMaterialIndex];
      aiString name;
      if (aiGetMaterialString(&material, AI_MATKEY_NAME, &name) == aiReturn_SUCCESS)
         mesh.material = name.C_Str();
      aiColor4D colour;
      if (aiGetMaterialColor(&material, AI_MATKEY_COLOR_DIFFUSE, &colour) == aiReturn_SUCCESS)
         mesh.colour = {colour.r, colour.g, colour.b};
      meshes.push_back(std::move(mesh));
   }
   for (unsigned c = 0; c < node.mNumChildren; ++c)
      readNode(scene, *node.mChildren[c], here, meshes);
}

/// Nothing when assimp refuses the file.
inline std::vector<ReadMesh> readWithAssimp(const std::string &file)
{
   const std::unique_ptr<const aiScene, void (*)(const aiScene *)> scene(aiImportFile(file.c_str(), 0),
                                                                         aiReleaseImport);
   std::vector<ReadMesh> meshes;
   if (scene)
      readNode(*scene, *scene->mRootNode, {}, meshes);
   return meshes;
}

} // namespace diatom::test
