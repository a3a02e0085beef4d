// A zip in memory, with fixed names and dates, so that equal content gives equal bytes.
#pragma once

#include "core/result.h"

#include <map>
#include <string>
#include <string_view>

namespace diatom {

/// Entry name to content.
using Entries = std::map<std::string, std::string>;

Result<std::string> writeArchive(const Entries &entries);

/// Reads every entry. Refuses archives whose entries are more than `entryLimit` or together larger than
/// `byteLimit` once unpacked, before unpacking any; `name` stands for the file.
Result<Entries> readArchive(std::string_view bytes, const std::string &name, std::size_t entryLimit,
                            std::uint64_t byteLimit);

} // namespace diatom
