#include "io/mesh_pack.h"

#include "core/check.h"

#include <cstring>
#include <type_traits>

namespace diatom {

namespace {

class Writer
{
public:
   template<typename T>
   void put(const T &value)
   {
      static_assert(std::is_trivially_copyable_v<T>);
      bytes.append(reinterpret_cast<const char *>(&value), sizeof value);
   }
   void put(const std::string &text)
   {
      put(text.size());
      bytes += text;
   }
   template<typename T>
   void array(const std::vector<T> &values)
   {
      put(values.size());
      bytes.append(reinterpret_cast<const char *>(values.data()), values.size() * sizeof(T));
   }
   std::string bytes;
};

class Reader
{
public:
   explicit Reader(std::string_view bytes) : m_bytes(bytes) {}
   template<typename T>
   T get()
   {
      T value;
      copy(&value, sizeof value);
      return value;
   }
   std::string text()
   {
      std::string text(get<std::size_t>(), '\0');
      copy(text.data(), text.size());
      return text;
   }
   template<typename T>
   std::vector<T> array()
   {
      std::vector<T> values(get<std::size_t>());
      copy(values.data(), values.size() * sizeof(T));
      return values;
   }

private:
   void copy(void *to, std::size_t size)
   {
      DIATOM_CHECK(size <= m_bytes.size());
      std::memcpy(to, m_bytes.data(), size);
      m_bytes.remove_prefix(size);
   }
   std::string_view m_bytes;
};

} // namespace

std::string packMesh(const Result<MeshRead> &read)
{
   Writer out;
   out.put(read.ok());
   if (!read) {
      out.put(read.error().code);
      out.put(read.error().message);
      return std::move(out.bytes);
   }
   out.array(read->mesh.vertices);
   out.array(read->mesh.triangles);
   out.array(read->mesh.piece);
   out.put(read->mesh.pieces.size());
   for (const auto &piece : read->mesh.pieces) {
      out.put(piece.name);
      out.put(piece.color);
      out.put(piece.colored);
   }
   out.put(read->format);
   out.put(read->notes.size());
   for (const std::string &note : read->notes)
      out.put(note);
   return std::move(out.bytes);
}

Result<MeshRead> unpackMesh(std::string_view bytes)
{
   Reader in(bytes);
   if (!in.get<bool>()) {
      const auto code = in.get<ErrorCode>();
      return Error{code, in.text()};
   }
   MeshRead read;
   read.mesh.vertices = in.array<Vec3>();
   read.mesh.triangles = in.array<std::array<std::int32_t, 3>>();
   read.mesh.piece = in.array<std::int32_t>();
   read.mesh.pieces.resize(in.get<std::size_t>());
   for (auto &piece : read.mesh.pieces) {
      piece.name = in.text();
      piece.color = in.get<std::array<std::uint8_t, 3>>();
      piece.colored = in.get<bool>();
   }
   read.format = in.text();
   read.notes.resize(in.get<std::size_t>());
   for (std::string &note : read.notes)
      note = in.text();
   return read;
}

} // namespace diatom
