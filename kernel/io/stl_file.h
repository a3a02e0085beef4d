// One STL file while it is written: triangles in, binary or ASCII out, complete or not there at all.
#pragma once

#include "core/file.h"
#include "core/result.h"
#include "core/vec.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace diatom {

/// Not copyable; one thread.
class StlFile
{
public:
   /// What a binary file can count.
   static constexpr std::uint64_t kMost = 0xffff'ffff;

   /// `unit` is metres per STL unit. Standard output cannot be patched: a binary file that goes there needs
   /// its number of triangles beforehand in `known`.
   StlFile(const std::filesystem::path &file, bool ascii, double unit, std::uint64_t known = 0,
           std::uint64_t most = kMost);

   /// Corners in metres, counter-clockwise from outside. The normal is computed here in double precision.
   void triangle(const Vec3 &a, const Vec3 &b, const Vec3 &c);
   std::uint64_t triangles() const { return m_triangles; }
   std::uint64_t bytes() const { return m_file.written(); }
   /// Puts the file in place; refuses more triangles than the format can count.
   Status commit();

private:
   std::filesystem::path m_path;
   AtomicFile m_file;
   bool m_ascii;
   double m_perMetre;
   std::uint64_t m_triangles = 0, m_most;
   std::string m_text;
};

} // namespace diatom
