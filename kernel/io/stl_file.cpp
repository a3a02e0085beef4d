#include "io/stl_file.h"

#include "core/text.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

namespace diatom {

namespace {

constexpr std::size_t kHeaderBytes = 80, kTriangleBytes = 50;

void putWord(char *to, std::uint32_t value)
{
   for (int i = 0; i < 4; ++i)
      to[i] = static_cast<char>(value >> (8 * i));
}

std::string countBytes(std::uint64_t count)
{
   std::string bytes(4, '\0');
   putWord(bytes.data(), static_cast<std::uint32_t>(count));
   return bytes;
}

} // namespace

StlFile::StlFile(const std::filesystem::path &file, bool ascii, double unit, std::uint64_t known,
                 std::uint64_t most)
    : m_path(file), m_file(file), m_ascii(ascii), m_perMetre(1 / unit), m_most(most)
{
   if (m_ascii) {
      m_file.write("solid diatom\n");
      return;
   }
   // No date: the same design gives the same file. Never "solid", by which readers know ASCII.
   std::string header = "Diatom STL, one unit is " + numberText(unit) + " m";
   header.resize(kHeaderBytes, ' ');
   m_file.write(header);
   m_file.write(countBytes(known));
}

void StlFile::triangle(const Vec3 &a, const Vec3 &b, const Vec3 &c)
{
   if (++m_triangles > m_most)
      return;
   Vec3 normal = (b - a).cross(c - a);
   const double length = normal.norm();
   normal = length > 0 ? Vec3(normal / length) : Vec3::Zero();
   const Vec3 rows[4] = {normal, a * m_perMetre, b * m_perMetre, c * m_perMetre};
   if (!m_ascii) {
      char record[kTriangleBytes] = {};
      for (int row = 0; row < 4; ++row)
         for (int axis = 0; axis < 3; ++axis)
            putWord(record + 12 * row + 4 * axis,
                    std::bit_cast<std::uint32_t>(static_cast<float>(rows[row][axis])));
      m_file.write({record, sizeof record});
      return;
   }
   m_text.clear();
   for (int row = 0; row < 4; ++row) {
      m_text += row == 0 ? "facet normal" : "    vertex";
      for (int axis = 0; axis < 3; ++axis)
         m_text += ' ' + singleText(static_cast<float>(rows[row][axis]));
      m_text += row == 0 ? "\n  outer loop\n" : "\n";
   }
   m_text += "  endloop\nendfacet\n";
   m_file.write(m_text);
}

Status StlFile::commit()
{
   if (m_triangles > m_most)
      return Error{ErrorCode::unwritable,
                   fmt::format("{}: {} triangles are more than the {} that an STL file can count; export by "
                               "material or in pieces; the old file, if any, is as it was",
                               m_path.string(), m_triangles, m_most)};
   if (m_ascii)
      m_file.write("endsolid diatom\n");
   else if (m_path != "-")
      m_file.writeAt(kHeaderBytes, countBytes(m_triangles));
   return m_file.commit();
}

} // namespace diatom
