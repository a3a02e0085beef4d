// MagicaVoxel's .vox files, in and out: cubes of up to 255 colours, in models of at most 256 cells along an
// axis that a scene puts together.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "formats/files.h"

#include <string>
#include <string_view>

namespace diatom {

inline constexpr std::string_view kVoxStart = "VOX ";
/// What the format does not say: the edge of a cell, m.
inline constexpr double kVoxPitch = 1e-3;

/// Every colour that is used becomes a material "color-N" of its number in the palette, by which writing
/// finds it again. Hidden models, and every frame but the first, are left out with a note. Errors name the
/// byte.
Result<Opened> readVox(std::string_view bytes, const std::string &name, const Job &job);

/// Refuses lattices other than cubes, more than 255 materials, and more than a million models. Lattice size,
/// orientations, simulation and composites are lost: a note says which of them the design had.
Result<std::string> writeVox(const Design &design, const Hierarchy &hierarchy,
                             std::vector<std::string> &notes, const Job &job);

} // namespace diatom
