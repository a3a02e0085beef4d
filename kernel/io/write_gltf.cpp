// glTF 2.0, binary (.glb) or JSON that holds its numbers as base64 (.gltf). No normals: readers then shade
// flat (specification 3.7.2.1), and triangles share their vertices.
#include "core/base64.h"
#include "core/file.h"
#include "io/geometry_writers.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace diatom {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kSingle = 5126, kIndex = 5125, kVertices = 34962, kIndices = 34963; // of the specification

/// Screens' sRGB to the linear light that glTF asks for (IEC 61966-2-1).
double linear(std::uint8_t part)
{
   const double c = part / 255.0;
   return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

class GltfWriter
{
public:
   explicit GltfWriter(const Geometry &geometry) : m_geometry(geometry)
   {
      m_json["asset"] = {{"version", "2.0"}, {"generator", "Diatom"}};
      m_json["scene"] = 0;
      m_json["scenes"] = {{{"nodes", {0}}}};
      // Designs have z upwards, glTF has y.
      const double half = std::sqrt(0.5);
      m_json["nodes"] = {
          {{"name", "design"}, {"rotation", {-half, 0, 0, half}}, {"children", Json::array()}}};
      for (const char *list : {"meshes", "materials", "accessors", "bufferViews"})
         m_json[list] = Json::array();
   }

   void add(const Solid &solid)
   {
      Json mesh{{"name", solid.name}, {"primitives", Json::array()}};
      const std::size_t positions = addPositions(solid.mesh);
      std::map<MaterialIndex, std::string> indices;
      for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t)
         for (const std::uint32_t corner : solid.mesh.triangles[t])
            putWord(indices[solid.mesh.materials[t]], corner);
      for (const auto &[material, bytes] : indices)
         mesh["primitives"].push_back(
             {{"attributes", {{"POSITION", positions}}},
              {"indices", addAccessor(bytes, kIndices, kIndex, "SCALAR", bytes.size() / 4)},
              {"material", materialNumber(material)}});
      m_json["nodes"][0]["children"].push_back(m_json["nodes"].size());
      m_json["nodes"].push_back({{"name", solid.name}, {"mesh", m_json["meshes"].size()}});
      m_json["meshes"].push_back(std::move(mesh));
   }

   std::uint64_t bytes() const { return m_bytes.size(); }

   std::string text()
   {
      m_json["buffers"] = {{{"byteLength", m_bytes.size()},
                            {"uri", "data:application/octet-stream;base64," + toBase64(m_bytes)}}};
      return m_json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
   }

   /// Header, JSON chunk, binary chunk (specification 4.4).
   std::string binary()
   {
      m_json["buffers"] = {{{"byteLength", m_bytes.size()}}};
      std::string json = m_json.dump(-1, ' ', false, Json::error_handler_t::replace);
      json.resize((json.size() + 3) / 4 * 4, ' ');
      std::string file = "glTF";
      putWord(file, 2);
      putWord(file, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + m_bytes.size()));
      putWord(file, static_cast<std::uint32_t>(json.size()));
      file += "JSON" + json;
      putWord(file, static_cast<std::uint32_t>(m_bytes.size()));
      file += std::string("BIN\0", 4) + m_bytes;
      return file;
   }

private:
   std::size_t addAccessor(const std::string &bytes, int target, int component, const char *type,
                           std::size_t count)
   {
      m_json["bufferViews"].push_back(
          {{"buffer", 0}, {"byteOffset", m_bytes.size()}, {"byteLength", bytes.size()}, {"target", target}});
      m_bytes += bytes; // all of 4-byte numbers: offsets are aligned
      m_json["accessors"].push_back({{"bufferView", m_json["bufferViews"].size() - 1},
                                     {"componentType", component},
                                     {"count", count},
                                     {"type", type}});
      return m_json["accessors"].size() - 1;
   }

   std::size_t addPositions(const SolidMesh &mesh)
   {
      std::string bytes;
      std::array<float, 3> least{}, most{};
      for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
         for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto value = static_cast<float>(mesh.vertices[v][static_cast<Eigen::Index>(axis)]);
            putSingle(bytes, value);
            least[axis] = v == 0 ? value : std::min(least[axis], value);
            most[axis] = v == 0 ? value : std::max(most[axis], value);
         }
      const std::size_t number = addAccessor(bytes, kVertices, kSingle, "VEC3", mesh.vertices.size());
      m_json["accessors"][number]["min"] = least;
      m_json["accessors"][number]["max"] = most;
      return number;
   }

   std::size_t materialNumber(MaterialIndex index)
   {
      const auto [found, added] = m_materials.emplace(index, m_materials.size());
      if (added) {
         const Material &material = m_geometry.material(index);
         m_json["materials"].push_back(
             {{"name", material.id},
              {"pbrMetallicRoughness",
               {{"baseColorFactor",
                 {linear(material.color[0]), linear(material.color[1]), linear(material.color[2]), 1.0}},
                {"metallicFactor", 0.0},
                {"roughnessFactor", 0.8}}}});
      }
      return found->second;
   }

   const Geometry &m_geometry;
   Json m_json;
   std::string m_bytes;
   std::map<MaterialIndex, std::size_t> m_materials;
};

} // namespace

Written writeGltf(const Geometry &geometry, bool binary, const std::filesystem::path &file, const Job &job)
{
   GltfWriter writer(geometry);
   for (const Solid &solid : geometry.solids) {
      if (job.cancelled())
         return exportCancelled();
      job.progress(0, "writing " + solid.name);
      writer.add(solid);
      if (writer.bytes() > 0xf000'0000)
         return Error{ErrorCode::unwritable,
                      file.string() +
                          ": more than the 4 GB that a glTF file can hold; export it by material or "
                          "as STL"};
   }
   const std::string bytes = binary ? writer.binary() : writer.text();
   if (const Status done = writeFileAtomic(file, bytes); !done)
      return done.error();
   return bytes.size();
}

} // namespace diatom
