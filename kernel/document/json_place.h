// Reading checked JSON with its place at hand: every getter knows its JSON pointer, and the first fault is
// kept.
#pragma once

#include "core/index.h"
#include "core/result.h"
#include "plugins/values.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// What a reader found: the first fault, and keys it does not know.
struct ReadLog
{
   std::string name; // stands for the file in messages
   std::optional<Error> error;
   nlohmann::json unknown = nlohmann::json::object(); // JSON pointer -> value

   bool ok() const { return !error; }
};

/// A value and the way to it. Lives on the stack of the reading function; the parent must outlive it. Getters
/// return a harmless default after a fault, so that readers need to look at ReadLog::ok() in loops and at the
/// end only.
class JsonPlace
{
public:
   JsonPlace(const nlohmann::json &root, ReadLog &log) : m_value(&root), m_log(&log) {}

   const nlohmann::json &json() const { return *m_value; }
   std::string pointer() const;
   ReadLog &log() const { return *m_log; }
   bool ok() const { return m_log->ok(); }
   /// "FILE: /pointer: problem".
   void fail(std::string_view problem) const;
   /// "... must be WHAT".
   void mustBe(std::string_view what) const;

   /// Members. has() is false for absent and null ones.
   bool has(std::string_view key) const;
   JsonPlace at(std::string_view key) const; // fails when absent
   JsonPlace at(std::size_t element) const;  // of an array, in range
   std::size_t size() const;                 // of an array; fails on anything else
   bool object() const;                      // fails on anything else
   bool array(std::size_t size) const;       // of exactly that size; fails on anything else
   /// Keeps every member that is not among `keys` in the log.
   void known(std::initializer_list<std::string_view> keys) const;

   double number(double least = -std::numeric_limits<double>::max(),
                 double most = std::numeric_limits<double>::max()) const;
   std::int64_t integer(std::int64_t least, std::int64_t most) const;
   bool boolean() const;
   std::string text() const;
   std::string identifier() const; // [A-Za-z0-9_.-]+
   std::array<std::uint8_t, 3> color() const;
   Index index() const; // [x, y, z]
   std::array<double, 3> numbers3() const;
   Values values() const;
   /// Position of the text in `words`; fails naming them all.
   std::size_t word(std::initializer_list<std::string_view> words) const;

   double numberOr(std::string_view key, double fallback, double least = -std::numeric_limits<double>::max(),
                   double most = std::numeric_limits<double>::max()) const;
   std::string textOr(std::string_view key, std::string fallback) const;
   bool booleanOr(std::string_view key, bool fallback) const;

private:
   JsonPlace(const nlohmann::json &value, const JsonPlace &parent, std::string_view key, std::size_t element)
       : m_value(&value), m_log(parent.m_log), m_parent(&parent), m_key(key), m_element(element)
   {}

   const nlohmann::json *m_value;
   ReadLog *m_log;
   const JsonPlace *m_parent = nullptr;
   std::string_view m_key;
   std::size_t m_element = 0;
};

bool isIdentifier(std::string_view text);
/// "#aabbcc" or "#abc".
std::optional<std::array<std::uint8_t, 3>> parseColor(std::string_view text);
std::string colorText(const std::array<std::uint8_t, 3> &color);

} // namespace diatom
