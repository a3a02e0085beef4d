// A verification case: a question to the solver and the answers that were found in another way.
#pragma once

#include "core/result.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

struct Case
{
   std::filesystem::path file;
   std::string id, form, name;
   std::vector<std::string> expectedPaths; // patterns of the values that are asked for
   nlohmann::json content;                 // the whole file
};

/// Reads a case. Errors: what cannot be read, or has no form, in one sentence.
Result<Case> readCase(const std::filesystem::path &file);
Result<Case> parseCase(std::string_view text, const std::filesystem::path &file);

/// A value that a case asks for: a number, a list of numbers, or a word.
struct AskedValue
{
   std::string path; // keys and positions from the top, joined by dots
   std::vector<double> numbers;
   std::string word; // where there are no numbers
};

/// All values whose path, or that of something they lie in, matches one of the case's patterns, in the order
/// of the file. A word is a value only where a pattern ends with its key; elsewhere words explain.
std::vector<AskedValue> askedValues(const Case &one);

/// Whether a path matches a pattern in which * stands for any characters, dots included, and ? for one.
bool matchesPattern(std::string_view path, std::string_view pattern);

} // namespace diatom
