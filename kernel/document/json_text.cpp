#include "document/json_text.h"

#include "core/text.h"

#include <fmt/format.h>

namespace diatom {

namespace {

using nlohmann::ordered_json;

constexpr std::size_t kLineWidth = 100;

void appendScalar(std::string &out, const ordered_json &value)
{
   if (value.is_number_float()) {
      const double number = value.get<double>();
      const auto text = numberText(number);
      out += text;
      // "-0" would read back as the integer 0.
      if (text == "-0")
         out += ".0";
   } else if (value.is_string()) {
      out += value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
   } else {
      out += value.dump();
   }
}

/// Appends in one line; gives up (false) once the text has grown past `limit`.
bool appendLine(std::string &out, const ordered_json &value, std::size_t limit)
{
   if (!value.is_structured()) {
      appendScalar(out, value);
      return out.size() <= limit;
   }
   const bool object = value.is_object();
   out += object ? '{' : '[';
   bool first = true;
   for (auto item = value.begin(); item != value.end(); ++item) {
      if (!first)
         out += ", ";
      first = false;
      if (object) {
         appendScalar(out, item.key());
         out += ": ";
      }
      if (!appendLine(out, *item, limit))
         return false;
   }
   out += object ? '}' : ']';
   return out.size() <= limit;
}

void appendIndented(std::string &out, const ordered_json &value, std::size_t depth)
{
   std::string line;
   if (appendLine(line, value, kLineWidth > 2 * depth ? kLineWidth - 2 * depth : 0) ||
       !value.is_structured() || value.empty())
   {
      out += line;
      return;
   }
   const bool object = value.is_object();
   out += object ? "{\n" : "[\n";
   bool first = true;
   for (auto item = value.begin(); item != value.end(); ++item) {
      if (!first)
         out += ",\n";
      first = false;
      out.append(2 * (depth + 1), ' ');
      if (object) {
         appendScalar(out, item.key());
         out += ": ";
      }
      appendIndented(out, *item, depth + 1);
   }
   out += '\n';
   out.append(2 * depth, ' ');
   out += object ? '}' : ']';
}

/// Byte at which brackets nest deeper than allowed, or npos.
std::size_t tooDeep(std::string_view text)
{
   int depth = 0;
   bool quoted = false;
   for (std::size_t i = 0; i < text.size(); ++i) {
      const char c = text[i];
      if (quoted) {
         if (c == '\\')
            ++i;
         else if (c == '"')
            quoted = false;
      } else if (c == '"') {
         quoted = true;
      } else if (c == '[' || c == '{') {
         if (++depth > kJsonDepth)
            return i;
      } else if (c == ']' || c == '}') {
         --depth;
      }
   }
   return std::string_view::npos;
}

/// The library's message without its "[json.exception...] " prefix.
std::string reason(const std::exception &error)
{
   std::string_view what = error.what();
   if (const auto end = what.find("] "); what.starts_with('[') && end != std::string_view::npos)
      what.remove_prefix(end + 2);
   return std::string(what);
}

} // namespace

std::string jsonText(const ordered_json &value)
{
   std::string out;
   appendIndented(out, value, 0);
   out += '\n';
   return out;
}

std::string jsonLine(const ordered_json &value)
{
   std::string out;
   appendLine(out, value, static_cast<std::size_t>(-1));
   return out;
}

Result<nlohmann::json> parseJson(std::string_view text, const std::string &name)
{
   if (text.starts_with("\xef\xbb\xbf"))
      text.remove_prefix(3);
   if (const auto byte = tooDeep(text); byte != std::string_view::npos)
      return Error{ErrorCode::unreadable,
                   fmt::format("{}: byte {}: brackets nest deeper than {} levels, which no "
                               "design needs; the file is damaged or not a design",
                               name, byte + 1, kJsonDepth)};
   try {
      return nlohmann::json::parse(text);
   } catch (const nlohmann::json::parse_error &error) {
      return Error{ErrorCode::unreadable,
                   fmt::format("{}: byte {}: it is not complete JSON ({}); restore the file from a copy",
                               name, error.byte, reason(error))};
   } catch (const std::exception &error) {
      return Error{
          ErrorCode::unreadable,
          fmt::format("{}: it cannot be used as JSON ({}); correct that value", name, reason(error))};
   }
}

} // namespace diatom
