// Designs from and to files. The format is told by content, never by suffix, when reading.
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "document/design.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// A design that was read, with what the reader has to say about it.
struct Opened
{
   Design design;
   std::string format;             // "diatom", "amoeba", "dmdesign", "vox", "vxc", "vxa"
   std::vector<std::string> notes; // kept-but-unknown keys, assumptions made on import
};

/// Reads a .diatom document (JSON, or zip with packed cells) or a file of the earlier programs. Errors name
/// the file, the place in it (JSON pointer, byte) and the remedy.
Result<Opened> openDesign(const std::filesystem::path &file, const Job &job);
/// The same for bytes already read; `name` stands for the file in messages.
Result<Opened> readDesign(std::string_view bytes, const std::string &name, const Job &job);

/// Writes a .diatom document atomically: readable JSON when small, a zip with packed cell blocks when large.
Status saveDesign(const Design &design, const std::filesystem::path &file, const Job &job);
/// The document's bytes. `packed` forces the zip form.
Result<std::string> writeDesign(const Design &design, bool packed, const Job &job);

} // namespace diatom
