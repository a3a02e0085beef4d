// SHA-256 (FIPS 180-4): the name of a file's content where someone may want two files to share it.
#pragma once

#include <string>
#include <string_view>

namespace diatom {

/// 64 lower-case hexadecimal digits.
std::string sha256(std::string_view bytes);

} // namespace diatom
