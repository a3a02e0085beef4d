// A 128-bit content hash (XXH3), the same on every machine of one byte order.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

struct XXH3_state_s;

namespace diatom {

struct Hash
{
   std::uint64_t high = 0, low = 0;
   friend bool operator==(const Hash &, const Hash &) = default;
   friend auto operator<=>(const Hash &, const Hash &) = default;
   /// 32 lower-case hexadecimal digits.
   std::string text() const;
};

/// Feeds bytes, numbers and text in order; text and spans are preceded by their length so that borders count.
class Hasher
{
public:
   Hasher();
   ~Hasher();
   Hasher(const Hasher &) = delete;
   Hasher &operator=(const Hasher &) = delete;

   void bytes(const void *data, std::size_t count);
   template<typename T>
   requires std::is_arithmetic_v<T> || std::is_enum_v<T>
   void add(T value) { bytes(&value, sizeof value); }
   void add(std::string_view text)
   {
      add(std::uint64_t{text.size()});
      bytes(text.data(), text.size());
   }
   template<typename T>
   requires std::is_arithmetic_v<T>
   void add(std::span<const T> values)
   {
      add(std::uint64_t{values.size()});
      bytes(values.data(), values.size_bytes());
   }
   Hash finish() const;

private:
   XXH3_state_s *m_state;
};

} // namespace diatom
