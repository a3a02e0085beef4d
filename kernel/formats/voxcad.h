// VoxCAD's files: .vxc, a lattice of stretched cubes with a palette of materials, and .vxa, the same with
// gravity, a floor and fixed regions.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "formats/files.h"

#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// Of a file: memory and time of a reader are bounded by what the file says.
inline constexpr double kMostVoxels = 4e9;

/// Whether XML text holds one.
bool isVoxcad(std::string_view bytes);

/// Notes name what was left out: thermal expansion, forces of regions, materials that are not linear, cells
/// that are no boxes. Errors name the byte.
Result<Opened> readVoxcad(std::string_view bytes, const std::string &name, const Job &job);

/// Materials keep density, Young's modulus, Poisson's ratio and colour; `world` adds gravity, ground, damping
/// and what holds whole boxes. Refuses other lattices than cubes and more than 255 materials.
Result<std::string> writeVoxcad(const Design &design, const Hierarchy &hierarchy, bool world,
                                std::vector<std::string> &notes, const Job &job);

} // namespace diatom
