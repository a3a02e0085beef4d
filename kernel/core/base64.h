// Base64 (RFC 4648), for formats that put bytes into text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace diatom {

std::string toBase64(std::string_view bytes);
/// White space is skipped; nothing when the text is no Base64.
std::optional<std::string> fromBase64(std::string_view text);

} // namespace diatom
