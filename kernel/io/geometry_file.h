// Solids to a file: 3MF, OBJ, PLY or glTF, told by the suffix. Written whole or not at all.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "io/geometry.h"

#include <filesystem>
#include <optional>
#include <string>

namespace diatom {

enum class GeometryFormat { stl, threeMf, obj, ply, gltf, glb };

/// By the suffix, in any case; nothing for other suffixes.
std::optional<GeometryFormat> geometryFormat(const std::filesystem::path &file);
/// ".3mf .glb ..." for sentences.
std::string geometrySuffixes();

/// One solid or more, in units of `unit` metres. glTF is in metres by definition and 3MF knows six units;
/// others are refused. `-` goes to standard output. Returns the bytes written.
Result<std::uint64_t> writeGeometry(const Geometry &geometry, GeometryFormat format, double unit,
                                    const std::filesystem::path &file, const Job &job);

} // namespace diatom
