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
/// The file's bytes; notes tell every loss. Errors: what the format cannot hold.
Result<std::string> writeForeign(const ForeignFormat &format, const Design &design,
                                 const Hierarchy &hierarchy, std::vector<std::string> &notes, const Job &job);
/// By name, else by the suffix of the file where that says it all; null when there is none.
const ForeignFormat *foreignFormat(std::string_view name, const std::filesystem::path &file);

} // namespace diatom
