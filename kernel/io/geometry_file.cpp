#include "io/geometry_file.h"

#include "io/geometry_writers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>

namespace diatom {

namespace {

constexpr std::array<std::pair<const char *, GeometryFormat>, 6> kFormats = {
    {{".stl", GeometryFormat::stl},
     {".3mf", GeometryFormat::threeMf},
     {".obj", GeometryFormat::obj},
     {".ply", GeometryFormat::ply},
     {".gltf", GeometryFormat::gltf},
     {".glb", GeometryFormat::glb}}};

/// Single precision has 24 bits: beyond 2^22 of the shortest edge, neighbouring corners begin to coincide.
Status checkReach(const Geometry &geometry)
{
   double reach = 0, shortest = 0;
   for (const Solid &solid : geometry.solids) {
      for (const Vec3 &vertex : solid.mesh.vertices) {
         if (!vertex.allFinite())
            return Error{ErrorCode::invalid, "the surface has a corner that is not a finite place"};
         reach = std::max(reach, vertex.lpNorm<Eigen::Infinity>());
      }
      for (const auto &[a, b, c] : solid.mesh.triangles) {
         const double edge = (solid.mesh.vertices[a] - solid.mesh.vertices[b]).norm();
         shortest = shortest == 0 ? edge : std::min(shortest, edge);
      }
   }
   if (reach > (1 << 22) * shortest && shortest > 0)
      return Error{ErrorCode::invalid, "the design reaches more than four million times its shortest edge "
                                       "from the origin, where single-precision "
                                       "numbers cannot tell its corners apart; move it nearer to the origin"};
   return {};
}

} // namespace

std::optional<GeometryFormat> geometryFormat(const std::filesystem::path &file)
{
   std::string suffix = file.extension().string();
   std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                  [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
   for (const auto &[known, format] : kFormats)
      if (suffix == known)
         return format;
   return {};
}

std::string geometrySuffixes()
{
   std::string all;
   for (const auto &[suffix, format] : kFormats)
      all += (all.empty() ? "" : " ") + std::string(suffix);
   return all;
}

Result<std::uint64_t> writeGeometry(const Geometry &geometry, GeometryFormat format, double unit,
                                    const std::filesystem::path &file, const Job &job)
{
   if (!(unit > 0) || !std::isfinite(unit))
      return Error{ErrorCode::usage, "the unit of a file must be a positive length"};
   if (!geometry.beams.empty() && format != GeometryFormat::threeMf)
      return Error{ErrorCode::usage, "only 3MF knows beams; choose a .3mf file or leave --beams out"};
   if (geometry.solids.empty() && geometry.beams.empty())
      return Error{ErrorCode::invalid,
                   fmt::format("{}: there is nothing to write; the design has no cells of "
                               "the kind asked for",
                               file.string())};
   if (const Status near = checkReach(geometry); !near)
      return near.error();
   switch (format) {
   case GeometryFormat::stl:
      return writeStlSolids(geometry, unit, file, job);
   case GeometryFormat::obj:
      return writeObj(geometry, unit, file, job);
   case GeometryFormat::ply:
      return writePly(geometry, unit, file, job);
   case GeometryFormat::threeMf:
      return write3mf(geometry, unit, file, job);
   case GeometryFormat::gltf:
   case GeometryFormat::glb:
      break;
   }
   if (unit != 1)
      return Error{ErrorCode::usage, "glTF is in metres by definition; leave --unit out or give m"};
   return writeGltf(geometry, format == GeometryFormat::glb, file, job);
}

void putWord(std::string &to, std::uint32_t value)
{
   for (int i = 0; i < 4; ++i)
      to += static_cast<char>(value >> (8 * i));
}

void putSingle(std::string &to, double value)
{
   putWord(to, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

} // namespace diatom
