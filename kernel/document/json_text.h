// JSON as people read it, always the same bytes for the same value; and JSON from bytes nobody has checked.
#pragma once

#include "core/result.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace diatom {

/// Two-space indents; whatever fits into one line stays in one. Keys in the object's own order, numbers by
/// core/text.h. Values must be finite and nested at most kJsonDepth deep.
std::string jsonText(const nlohmann::ordered_json &value);
/// The same in one line.
std::string jsonLine(const nlohmann::ordered_json &value);

/// Deeper nesting is refused: nothing we read needs it, and recursive code could not walk it.
inline constexpr int kJsonDepth = 64;

/// Parses text of any origin. Errors name the byte; `name` stands for the file.
Result<nlohmann::json> parseJson(std::string_view text, const std::string &name);

} // namespace diatom
