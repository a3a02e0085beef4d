// The files of other programs that designs are written to.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "document/design.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

struct ForeignFormat
{
   const char *name;    // "vox", "amoeba"
   const char *suffix;  // ".vox", ".json"
   const char *program; // for people
   Result<std::string> (*write)(const Design &design, const Hierarchy &hierarchy,
                                std::vector<std::string> &notes, const Job &job);
};

std::span<const ForeignFormat> foreignFormats();
/// By name, else by the suffix of the file where that says it all; null when there is none.
const ForeignFormat *foreignFormat(std::string_view name, const std::filesystem::path &file);

/// Written whole or not at all; `notes` tells what the format cannot hold. Errors name the file.
Status writeForeign(const Design &design, const Hierarchy &hierarchy, const ForeignFormat &format,
                    const std::filesystem::path &file, std::vector<std::string> &notes, const Job &job);

} // namespace diatom
