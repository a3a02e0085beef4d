// One function for each format that solids are written in.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "io/geometry.h"

#include <filesystem>

namespace diatom {

using Written = Result<std::uint64_t>; // bytes

/// Several solids are told apart by nothing but their shells.
Written writeStlSolids(const Geometry &geometry, double unit, const std::filesystem::path &file,
                       const Job &job);
/// With a .mtl of the same name beside it, unless it goes to standard output.
Written writeObj(const Geometry &geometry, double unit, const std::filesystem::path &file, const Job &job);
/// Binary; colours on faces and on vertices, as some readers look at the one and some at the other.
Written writePly(const Geometry &geometry, double unit, const std::filesystem::path &file, const Job &job);
/// In metres and with y upwards, as the format asks. `binary` is .glb; else JSON that holds its own numbers.
Written writeGltf(const Geometry &geometry, bool binary, const std::filesystem::path &file, const Job &job);
/// An object for each solid, base materials with their colours.
Written write3mf(const Geometry &geometry, double unit, const std::filesystem::path &file, const Job &job);

inline Error exportCancelled() { return {ErrorCode::cancelled, "the export was cancelled"}; }

/// Little-endian bytes.
void putWord(std::string &to, std::uint32_t value);
void putSingle(std::string &to, double value);

} // namespace diatom
