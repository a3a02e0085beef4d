#include "io/mesh_read.h"

#include "core/archive.h"
#include "core/child.h"
#include "core/file.h"
#include "io/mesh_pack.h"
#include "io/units_3mf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>

#ifdef DIATOM_ASSIMP
#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <map>
#endif

namespace diatom {

namespace {

constexpr std::size_t kMostEntries = 100'000;                   // of a 3MF file
constexpr std::uint64_t kMostUnpacked = std::uint64_t{4} << 30; // bytes

/// Lower case, without the dot.
std::string suffixOf(const std::filesystem::path &file)
{
   std::string suffix = file.extension().string();
   std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                  [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
   return suffix.empty() ? suffix : suffix.substr(1);
}

/// What the file itself says in the first tag of its model, which the library passes over.
double unitOf3mf(const std::filesystem::path &file)
{
   const auto bytes = readFile(file);
   const auto entries = bytes ? readArchive(*bytes, file.string(), kMostEntries, kMostUnpacked)
                              : Result<Entries>(bytes.error());
   if (!entries)
      return 1e-3; // reading the mesh says why
   for (const auto &[name, content] : *entries) {
      if (!name.ends_with(".model"))
         continue;
      const std::string_view head =
          std::string_view(content).substr(0, content.find('>', content.find("<model")));
      for (const auto &[metres, unit] : kUnits3mf)
         if (head.find(fmt::format("unit=\"{}\"", unit)) != std::string_view::npos)
            return metres;
   }
   return 1e-3;
}

} // namespace

double customaryUnit(const std::filesystem::path &file)
{
   const std::string suffix = suffixOf(file);
   if (suffix == "3mf")
      return unitOf3mf(file);
   return suffix == "gltf" || suffix == "glb" ? 1 : 1e-3;
}

#ifdef DIATOM_ASSIMP

namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{4} << 30;
constexpr std::size_t kMostPieces = 256;
constexpr int kDeepest = 1000;                               // nodes within nodes
constexpr double kLeastSeconds = 10, kSecondsPerByte = 2e-6; // ten times what slow formats take

using Color = std::array<std::uint8_t, 3>;

Color colorOf(const aiColor4D &color)
{
   const auto byte = [](float value) {
      return static_cast<std::uint8_t>(
          std::lround(255 * std::clamp(std::isnan(value) ? 0.0F : value, 0.0F, 1.0F)));
   };
   return {byte(color.r), byte(color.g), byte(color.b)};
}

class SceneReader
{
public:
   SceneReader(const aiScene &scene, double unit, MeshRead &read) : m_scene(scene), m_unit(unit), m_read(read)
   {}

   Status run()
   {
      node(*m_scene.mRootNode, aiMatrix4x4(), 0);
      if (m_left > 0)
         m_read.notes.push_back(
             fmt::format("{} points and lines of the file were left out: they have no inside", m_left));
      if (m_coarse)
         m_read.notes.push_back(
             fmt::format("the file has more than {} colours; similar ones were made one", kMostPieces));
      return m_fault.empty() ? Status() : Status(Error{ErrorCode::unreadable, m_fault});
   }

private:
   void node(const aiNode &from, const aiMatrix4x4 &parent, int depth)
   {
      if (depth > kDeepest) {
         m_fault = "its scene is nested too deeply; save it again as one mesh";
         return;
      }
      const aiMatrix4x4 pose = parent * from.mTransformation;
      for (unsigned k = 0; k < from.mNumMeshes && m_fault.empty(); ++k)
         mesh(*m_scene.mMeshes[from.mMeshes[k]], pose);
      for (unsigned k = 0; k < from.mNumChildren && m_fault.empty(); ++k)
         node(*from.mChildren[k], pose, depth + 1);
   }

   void mesh(const aiMesh &from, const aiMatrix4x4 &pose)
   {
      auto &to = m_read.mesh;
      const auto first = to.vertices.size();
      if (first + from.mNumVertices > 0x7fff'ffff) {
         m_fault = "it has more vertices than can be numbered; make it coarser";
         return;
      }
      for (unsigned k = 0; k < from.mNumVertices; ++k) {
         const auto p = pose * from.mVertices[k];
         const Vec3 point = m_unit * Vec3(p.x, p.y, p.z);
         if (!point.allFinite()) {
            m_fault =
                fmt::format("vertex {} of {} is not a number; repair the mesh and save it again", k + 1,
                            from.mName.length > 0 ? fmt::format("\"{}\"", from.mName.C_Str()) : "its mesh");
            return;
         }
         to.vertices.push_back(point);
      }
      // A mirroring transformation turns the surface inside out.
      const bool mirrored = aiMatrix3x3(pose).Determinant() < 0;
      const int whole = from.HasVertexColors(0) ? -1 : pieceOf(from);
      for (unsigned k = 0; k < from.mNumFaces; ++k) {
         const aiFace &face = from.mFaces[k];
         if (face.mNumIndices != 3) {
            ++m_left;
            continue;
         }
         std::array<std::int32_t, 3> corners{};
         for (unsigned c = 0; c < 3; ++c)
            corners[c] = static_cast<std::int32_t>(first + face.mIndices[c]);
         if (mirrored)
            std::swap(corners[1], corners[2]);
         to.triangles.push_back(corners);
         to.piece.push_back(whole >= 0 ? whole : pieceOf(from, face));
      }
   }

   /// The piece of a mesh that is of one material.
   int pieceOf(const aiMesh &mesh)
   {
      TriangleMesh::Piece piece;
      const aiMaterial &material = *m_scene.mMaterials[mesh.mMaterialIndex];
      aiString name;
      // Readers put a material of their own where the file has none.
      const bool named = material.Get(AI_MATKEY_NAME, name) == AI_SUCCESS && name.length > 0 &&
                         std::string_view(name.C_Str()) != AI_DEFAULT_MATERIAL_NAME;
      const bool plain = std::string_view(mesh.mName.C_Str()) == "defaultobject"; // of its OBJ reader
      piece.name = named ? name.C_Str() : plain ? "" : mesh.mName.C_Str();
      if (m_read.format == "3mf")
         piece.name = withoutNumber(piece.name);
      aiColor4D color;
      piece.colored = named && (material.Get(AI_MATKEY_BASE_COLOR, color) == AI_SUCCESS ||
                                material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS);
      if (piece.colored)
         piece.color = colorOf(color);
      return numberOf(piece);
   }

   /// The 3MF reader puts "id", a number and "_" before the file's own name.
   static std::string withoutNumber(const std::string &name)
   {
      const auto end = name.find_first_not_of("0123456789", 2);
      return name.starts_with("id") && end != std::string::npos && end > 2 && name[end] == '_'
                 ? name.substr(end + 1)
                 : name;
   }

   /// The piece of a face whose corners are coloured: that of their mean.
   int pieceOf(const aiMesh &mesh, const aiFace &face)
   {
      aiColor4D sum;
      for (unsigned c = 0; c < 3; ++c)
         sum = sum + mesh.mColors[0][face.mIndices[c]];
      TriangleMesh::Piece piece;
      piece.color = colorOf(sum * (1.0F / 3));
      piece.colored = true;
      if (m_coarse || m_numbers.size() >= kMostPieces)
         coarsen(piece.color);
      return numberOf(piece);
   }

   void coarsen(Color &color)
   {
      m_coarse = true;
      for (auto &channel : color)
         channel = static_cast<std::uint8_t>((channel & 0xc0) | 0x20);
   }

   int numberOf(const TriangleMesh::Piece &piece)
   {
      auto &pieces = m_read.mesh.pieces;
      const auto [at, added] =
          m_numbers.try_emplace({piece.name, piece.color}, static_cast<int>(pieces.size()));
      if (added)
         pieces.push_back(piece);
      return at->second;
   }

   const aiScene &m_scene;
   double m_unit;
   MeshRead &m_read;
   std::map<std::pair<std::string, Color>, int> m_numbers;
   std::uint64_t m_left = 0;
   bool m_coarse = false;
   std::string m_fault;
};

/// Only some of the library's readers tell how far they are.
class ReadProgress : public Assimp::ProgressHandler
{
public:
   explicit ReadProgress(ChildProgress progress) : m_progress(std::move(progress)) {}
   bool Update(float fraction) override
   {
      m_progress(fraction);
      return true; // goes on: who wants to stop ends the process
   }

private:
   ChildProgress m_progress;
};

Result<MeshRead> readWithAssimp(const std::filesystem::path &file, double unit, const ChildProgress &progress)
{
   const auto unreadable = [&](std::string_view why) {
      return Error{ErrorCode::unreadable, fmt::format("{}: {}", file.string(), why)};
   };
   Assimp::Importer importer;
   importer.SetProgressHandler(new ReadProgress(progress)); // the importer deletes it
   const aiScene *scene = importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_SortByPType |
                                                               aiProcess_ValidateDataStructure);
   if (!scene || !scene->mRootNode) {
      std::string why = importer.GetErrorString();
      std::replace(why.begin(), why.end(), '\n', ' ');
      return unreadable(fmt::format("it is no mesh that can be read ({}); save it again as binary STL", why));
   }
   MeshRead read;
   read.format = suffixOf(file);
   if (const Status done = SceneReader(*scene, unit, read).run(); !done)
      return unreadable(done.error().message);
   if (read.mesh.triangles.empty())
      return unreadable("it has no triangles; export a surface mesh");
   return read;
}

Result<MeshRead> readGuarded(const std::filesystem::path &file, double unit, const ChildProgress &progress)
{
   try {
      return readWithAssimp(file, unit, progress);
   } catch (const std::bad_alloc &) {
      return Error{ErrorCode::unreadable,
                   fmt::format("{}: there is not enough memory to read it; make it coarser", file.string())};
   } catch (const std::exception &error) {
      return Error{ErrorCode::unreadable,
                   fmt::format("{}: it cannot be read ({}); save it again as binary STL", file.string(),
                               error.what())};
   }
}

} // namespace

bool canReadMeshes() { return true; }

bool isMeshFile(const std::filesystem::path &file)
{
   const std::string suffix = suffixOf(file);
   return !suffix.empty() && suffix != "json" && Assimp::Importer().IsExtensionSupported("." + suffix);
}

Result<MeshRead> readMesh(const std::filesystem::path &file, double unit, const Job &job)
{
   std::error_code failed;
   const auto bytes = std::filesystem::file_size(file, failed);
   if (failed)
      return Error{ErrorCode::unreadable, fmt::format("{}: {}", file.string(), failed.message())};
   if (bytes > kMostBytes)
      return Error{ErrorCode::unreadable,
                   fmt::format("{}: it is larger than the {} bytes that a mesh may have; make it coarser",
                               file.string(), kMostBytes)};
   // The library hangs or crashes on some broken files.
   const double seconds = kLeastSeconds + kSecondsPerByte * static_cast<double>(bytes);
   auto packed =
       runInChild([&](const ChildProgress &progress) { return packMesh(readGuarded(file, unit, progress)); },
                  seconds, "reading the mesh", job);
   if (!packed)
      return Error{
          packed.error().code == ErrorCode::cancelled ? ErrorCode::cancelled : ErrorCode::unreadable,
          fmt::format("{}: reading it was given up: {}; repair the mesh and save it again as binary STL",
                      file.string(), packed.error().message)};
   return unpackMesh(*packed);
}

#else

bool canReadMeshes() { return false; }
bool isMeshFile(const std::filesystem::path &) { return false; }

Result<MeshRead> readMesh(const std::filesystem::path &file, double, const Job &)
{
   return Error{
       ErrorCode::unsupported,
       fmt::format("{}: this Diatom was built without assimp and reads no meshes; install libassimp-dev and "
                   "zlib1g-dev and build it again",
                   file.string())};
}

#endif

} // namespace diatom
