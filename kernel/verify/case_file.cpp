#include "verify/case_file.h"

#include "core/file.h"
#include "document/json_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace diatom {

namespace {

using nlohmann::json;

constexpr const char *kSchema = "dmref-1";
constexpr std::size_t kLargest = 64 << 20; // bytes

bool isNumbers(const json &value)
{
   return value.is_array() && !value.empty() &&
          std::all_of(value.begin(), value.end(), [](const json &one) { return one.is_number(); });
}

/// Whether what follows the pattern's last dot is the key itself.
bool endsWithKey(std::string_view pattern, std::string_view path)
{
   const auto last = [](std::string_view text) { return text.substr(text.rfind('.') + 1); };
   return last(pattern) == last(path);
}

class Walk
{
public:
   explicit Walk(const std::vector<std::string> &patterns) : m_patterns(patterns) {}

   void into(const json &value, const std::string &path, bool inside)
   {
      inside = inside || (!path.empty() && matches(path));
      if (inside && (value.is_number() || isNumbers(value))) {
         m_found.push_back(
             {path, value.is_number() ? std::vector{value.get<double>()} : value.get<std::vector<double>>(),
              ""});
         return;
      }
      if (value.is_string() && namesWord(path))
         m_found.push_back({path, {}, value.get<std::string>()});
      const std::string before = path.empty() ? "" : path + ".";
      if (value.is_object())
         for (const auto &[key, inner] : value.items())
            into(inner, before + key, inside);
      if (value.is_array())
         for (std::size_t i = 0; i < value.size(); ++i)
            into(value[i], before + std::to_string(i), inside);
   }
   std::vector<AskedValue> found() && { return std::move(m_found); }

private:
   bool matches(const std::string &path) const
   {
      return std::any_of(m_patterns.begin(), m_patterns.end(),
                         [&](const std::string &pattern) { return matchesPattern(path, pattern); });
   }

   bool namesWord(const std::string &path) const
   {
      return std::any_of(m_patterns.begin(), m_patterns.end(), [&](const std::string &pattern) {
         return endsWithKey(pattern, path) && matchesPattern(path, pattern);
      });
   }

   const std::vector<std::string> &m_patterns;
   std::vector<AskedValue> m_found;
};

} // namespace

bool matchesPattern(std::string_view path, std::string_view pattern)
{
   // After a mismatch the last * takes one character more; that is enough, since an earlier one never has to.
   std::size_t p = 0, t = 0, star = std::string_view::npos, taken = 0;
   while (t < path.size()) {
      if (p < pattern.size() && pattern[p] == '*') {
         star = p++;
         taken = t;
      } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == path[t])) {
         ++p;
         ++t;
      } else if (star != std::string_view::npos) {
         p = star + 1;
         t = ++taken;
      } else {
         return false;
      }
   }
   while (p < pattern.size() && pattern[p] == '*')
      ++p;
   return p == pattern.size();
}

Result<Case> parseCase(std::string_view text, const std::filesystem::path &file)
{
   const auto refuse = [&](const std::string &why) {
      return Error{
          ErrorCode::unreadable,
          fmt::format("{}: {}; docs/verification-cases.md says what a case holds", file.string(), why)};
   };
   Case one;
   one.file = file;
   auto parsed = parseJson(text, file.string());
   if (!parsed)
      return parsed.error();
   one.content = *std::move(parsed);
   const json &content = one.content;
   if (!content.is_object())
      return refuse("is no JSON object");
   if (content.value("schema", json()) != kSchema)
      return refuse(fmt::format("does not say \"schema\": \"{}\", so it is no verification case", kSchema));
   for (const auto &[key, to] : {std::pair{"id", &one.id}, std::pair{"form", &one.form}}) {
      const auto found = content.find(key);
      if (found == content.end() || !found->is_string())
         return refuse(fmt::format("has no text at \"{}\"", key));
      *to = found->get<std::string>();
   }
   const auto name = content.find("name");
   one.name = name != content.end() && name->is_string() ? name->get<std::string>() : one.id;
   const auto paths = content.find("expected_paths");
   if (paths == content.end() || !paths->is_array() || paths->empty() ||
       !std::all_of(paths->begin(), paths->end(), [](const json &path) { return path.is_string(); }))
      return refuse("has no list of texts at \"expected_paths\"");
   one.expectedPaths = paths->get<std::vector<std::string>>();
   return one;
}

Result<Case> readCase(const std::filesystem::path &file)
{
   const auto text = readFile(file, kLargest);
   if (!text)
      return text.error();
   return parseCase(*text, file);
}

std::vector<AskedValue> askedValues(const Case &one)
{
   Walk walk(one.expectedPaths);
   walk.into(one.content, "", false);
   return std::move(walk).found();
}

} // namespace diatom
