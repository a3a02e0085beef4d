#include "document/json_place.h"

#include "core/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

using nlohmann::json;

const json kNull;

std::string escaped(std::string_view key)
{
   std::string text;
   for (const char c : key) {
      if (c == '~')
         text += "~0";
      else if (c == '/')
         text += "~1";
      else
         text += c;
   }
   return text;
}

/// A scalar as the user wrote it, shortened.
std::string shortText(const json &value)
{
   auto text = value.dump(-1, ' ', false, json::error_handler_t::replace);
   if (text.size() > 40)
      text = text.substr(0, 37) + "...";
   return text;
}

} // namespace

std::string JsonPlace::pointer() const
{
   std::vector<const JsonPlace *> chain;
   for (const JsonPlace *place = this; place->m_parent; place = place->m_parent)
      chain.push_back(place);
   std::string text;
   for (auto place = chain.rbegin(); place != chain.rend(); ++place) {
      text += '/';
      text += (*place)->m_key.data() ? escaped((*place)->m_key) : std::to_string((*place)->m_element);
   }
   return text;
}

void JsonPlace::fail(std::string_view problem) const
{
   if (!m_log->error) {
      const auto place = pointer();
      m_log->error = Error{ErrorCode::unreadable, fmt::format("{}: {}: {}", m_log->name,
                                                              place.empty() ? "top level" : place, problem)};
   }
}

void JsonPlace::mustBe(std::string_view what) const
{
   fail(m_value->is_null()
            ? fmt::format("is missing: it must be {}", what)
            : fmt::format("must be {}, not {}", what,
                          m_value->is_structured() ? m_value->type_name() : shortText(*m_value)));
}

bool JsonPlace::has(std::string_view key) const
{
   if (!m_value->is_object())
      return false;
   const auto member = m_value->find(std::string(key));
   return member != m_value->end() && !member->is_null();
}

JsonPlace JsonPlace::at(std::string_view key) const
{
   if (m_value->is_object())
      if (const auto member = m_value->find(std::string(key)); member != m_value->end())
         return {*member, *this, key, 0};
   return {kNull, *this, key, 0};
}

JsonPlace JsonPlace::at(std::size_t element) const
{
   if (m_value->is_array() && element < m_value->size())
      return {(*m_value)[element], *this, {}, element};
   return {kNull, *this, {}, element};
}

std::size_t JsonPlace::size() const
{
   if (m_value->is_array())
      return m_value->size();
   mustBe("a list");
   return 0;
}

bool JsonPlace::object() const
{
   if (!m_value->is_object())
      mustBe("an object");
   return m_value->is_object();
}

bool JsonPlace::array(std::size_t size) const
{
   const bool good = m_value->is_array() && m_value->size() == size;
   if (!good)
      mustBe(fmt::format("a list of {}", size));
   return good;
}

void JsonPlace::known(std::initializer_list<std::string_view> keys) const
{
   if (!m_value->is_object())
      return;
   for (const auto &[key, value] : m_value->items())
      if (std::find(keys.begin(), keys.end(), key) == keys.end())
         m_log->unknown[pointer() + "/" + escaped(key)] = value;
}

double JsonPlace::number(double least, double most) const
{
   const bool any =
       most >= std::numeric_limits<double>::max() && least <= -std::numeric_limits<double>::max();
   const double value = m_value->is_number() ? m_value->get<double>() : std::nan("");
   if (value >= least && value <= most)
      return value;
   if (any)
      mustBe("a number");
   else if (most >= std::numeric_limits<double>::max())
      mustBe(fmt::format("a number of at least {}", numberText(least)));
   else
      mustBe(fmt::format("a number from {} to {}", numberText(least), numberText(most)));
   return std::max(0.0, least);
}

std::int64_t JsonPlace::integer(std::int64_t least, std::int64_t most) const
{
   // Beyond 2^53 neither we nor other programs that read JSON tell integers apart.
   const double value = m_value->is_number() ? m_value->get<double>() : std::nan("");
   if (value >= static_cast<double>(least) && value <= static_cast<double>(most) &&
       value == std::floor(value))
      return static_cast<std::int64_t>(value);
   mustBe(fmt::format("a whole number from {} to {}", least, most));
   return least;
}

bool JsonPlace::boolean() const
{
   if (m_value->is_boolean())
      return m_value->get<bool>();
   mustBe("true or false");
   return false;
}

std::string JsonPlace::text() const
{
   if (m_value->is_string())
      return m_value->get<std::string>();
   mustBe("a text");
   return {};
}

std::string JsonPlace::identifier() const
{
   if (m_value->is_string() && isIdentifier(m_value->get_ref<const std::string &>()))
      return m_value->get<std::string>();
   mustBe("an id of letters, digits, '_', '.' and '-'");
   return {};
}

std::array<std::uint8_t, 3> JsonPlace::color() const
{
   if (m_value->is_string())
      if (const auto color = parseColor(m_value->get_ref<const std::string &>()))
         return *color;
   mustBe("a colour like \"#cda4f3\"");
   return {};
}

Index JsonPlace::index() const
{
   if (!m_value->is_array() || m_value->size() != 3) {
      mustBe("an index [x, y, z]");
      return {};
   }
   const auto axis = [this](std::size_t a) {
      return static_cast<std::int32_t>(at(a).integer(-kIndexLimit, kIndexLimit));
   };
   return {axis(0), axis(1), axis(2)};
}

std::array<double, 3> JsonPlace::numbers3() const
{
   if (!m_value->is_array() || m_value->size() != 3) {
      mustBe("a list of three numbers");
      return {};
   }
   return {at(0).number(), at(1).number(), at(2).number()};
}

Values JsonPlace::values() const
{
   Values values;
   if (!object())
      return values;
   for (const auto &[key, value] : m_value->items()) {
      if (value.is_number())
         values[key] = at(key).number();
      else if (value.is_string())
         values[key] = value.get<std::string>();
      else
         at(key).mustBe("a number or a text");
   }
   return values;
}

std::size_t JsonPlace::word(std::initializer_list<std::string_view> words) const
{
   if (m_value->is_string()) {
      const auto found = std::find(words.begin(), words.end(), m_value->get_ref<const std::string &>());
      if (found != words.end())
         return static_cast<std::size_t>(found - words.begin());
   }
   mustBe(fmt::format("one of {}", fmt::join(words, ", ")));
   return 0;
}

double JsonPlace::numberOr(std::string_view key, double fallback, double least, double most) const
{
   return has(key) ? at(key).number(least, most) : fallback;
}

std::string JsonPlace::textOr(std::string_view key, std::string fallback) const
{
   return has(key) ? at(key).text() : std::move(fallback);
}

bool JsonPlace::booleanOr(std::string_view key, bool fallback) const
{
   return has(key) ? at(key).boolean() : fallback;
}

bool isIdentifier(std::string_view text)
{
   const auto good = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
             c == '.' || c == '-';
   };
   return !text.empty() && text.size() <= 200 && std::all_of(text.begin(), text.end(), good);
}

std::optional<std::array<std::uint8_t, 3>> parseColor(std::string_view text)
{
   if (!text.starts_with('#') || (text.size() != 4 && text.size() != 7))
      return std::nullopt;
   const auto digit = [](char c) {
      if (c >= '0' && c <= '9')
         return c - '0';
      if (c >= 'a' && c <= 'f')
         return c - 'a' + 10;
      return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
   };
   const bool brief = text.size() == 4;
   std::array<std::uint8_t, 3> color{};
   for (std::size_t i = 0; i < 3; ++i) {
      const int high = digit(text[brief ? 1 + i : 1 + 2 * i]), low = digit(text[brief ? 1 + i : 2 + 2 * i]);
      if (high < 0 || low < 0)
         return std::nullopt;
      color[i] = static_cast<std::uint8_t>(16 * high + low);
   }
   return color;
}

std::string colorText(const std::array<std::uint8_t, 3> &color)
{
   return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
}

} // namespace diatom
