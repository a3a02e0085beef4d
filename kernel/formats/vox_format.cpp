#include "formats/vox_format.h"

#include "core/text.h"

#include <fmt/format.h>

#include <cstdlib>

namespace diatom::vox {

namespace {

constexpr std::string_view kMaterialPrefix = "color-";

} // namespace

std::string_view Bytes::take(std::size_t count)
{
   if (m_failed || count > m_bytes.size() - m_at) {
      m_failed = true;
      return {};
   }
   const auto taken = m_bytes.substr(m_at, count);
   m_at += count;
   return taken;
}

Bytes Bytes::part(std::size_t count)
{
   const std::size_t from = at();
   return Bytes(take(count), from);
}

std::int32_t Bytes::number()
{
   const auto four = take(4);
   std::uint32_t value = 0;
   for (std::size_t k = 0; k < four.size(); ++k)
      value |= std::uint32_t{static_cast<std::uint8_t>(four[k])} << (8 * k);
   return static_cast<std::int32_t>(value);
}

Dictionary Bytes::dictionary()
{
   Dictionary entries;
   const auto text = [this] {
      const auto length = number();
      if (length < 0)
         m_failed = true;
      return std::string(take(length < 0 ? 0 : static_cast<std::size_t>(length)));
   };
   const auto count = number();
   for (std::int32_t k = 0; k < count && !m_failed; ++k) {
      auto key = text();
      entries[std::move(key)] = text();
   }
   return entries;
}

Pose operator*(const Pose &outer, const Pose &inner)
{
   Pose both;
   const std::array<std::int32_t, 3> shift{inner.shift.x, inner.shift.y, inner.shift.z};
   std::array<std::int32_t, 3> moved{};
   for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t k = 0; k < 3; ++k) {
         both.turn[r][k] = outer.turn[r][0] * inner.turn[0][k] + outer.turn[r][1] * inner.turn[1][k] +
                           outer.turn[r][2] * inner.turn[2][k];
         moved[r] += outer.turn[r][k] * shift[k];
      }
   both.shift = outer.shift + Index{moved[0], moved[1], moved[2]};
   return both;
}

Index Pose::cell(Index at, Index size) const
{
   // The low corner of the cell's image: a mirrored axis maps the cell from v to v + 1 onto -v - 1.
   const std::array<std::int32_t, 3> from{at.x - size.x / 2, at.y - size.y / 2, at.z - size.z / 2};
   std::array<std::int32_t, 3> to{shift.x, shift.y, shift.z};
   for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t k = 0; k < 3; ++k)
         to[r] += turn[r][k] > 0 ? from[k] : turn[r][k] < 0 ? -from[k] - 1 : 0;
   return {to[0], to[1], to[2]};
}

std::optional<Pose> poseOf(const Dictionary &frame)
{
   Pose pose;
   if (const auto found = frame.find("_t"); found != frame.end()) {
      std::array<std::int32_t, 3> shift{};
      std::string_view text = found->second;
      for (auto &value : shift) {
         const auto end = std::min(text.find(' '), text.size());
         const auto number = parseInteger(text.substr(0, end));
         if (!number || std::abs(*number) > kIndexLimit / 1024)
            return {};
         value = static_cast<std::int32_t>(*number);
         text.remove_prefix(std::min(end + 1, text.size()));
      }
      pose.shift = {shift[0], shift[1], shift[2]};
   }
   if (const auto found = frame.find("_r"); found != frame.end()) {
      // Bits 0-1, 2-3: column of the entry in rows 0, 1; bits 4-6: set where the entry of the row is -1.
      const auto bits = parseInteger(found->second);
      if (!bits || *bits < 0 || *bits > 127)
         return {};
      const auto first = static_cast<std::size_t>(*bits & 3),
                 second = static_cast<std::size_t>(*bits >> 2 & 3);
      if (first > 2 || second > 2 || first == second)
         return {};
      pose.turn = {};
      const std::array<std::size_t, 3> column{first, second, 3 - first - second};
      for (std::size_t row = 0; row < 3; ++row)
         pose.turn[row][column[row]] = *bits >> (4 + row) & 1 ? -1 : 1;
   }
   return pose;
}

Palette defaultPalette()
{
   // The cube of six levels but black, then ramps of red, green, blue and grey.
   Palette palette{};
   std::size_t n = 1;
   const auto level = [](std::size_t k) { return static_cast<std::uint8_t>(0xff - 0x33 * k); };
   for (std::size_t k = 0; k < 215; ++k)
      palette[n++] = {level(k / 36), level(k / 6 % 6), level(k % 6)};
   constexpr std::array<std::uint8_t, 10> ramp{0xee, 0xdd, 0xbb, 0xaa, 0x88, 0x77, 0x55, 0x44, 0x22, 0x11};
   for (std::size_t channel = 0; channel < 4; ++channel)
      for (const std::uint8_t value : ramp) {
         for (std::size_t c = 0; c < 3; ++c)
            palette[n][c] = c == channel || channel == 3 ? value : std::uint8_t{0};
         ++n;
      }
   return palette;
}

Palette readPalette(Bytes &in)
{
   Palette palette{};
   for (std::size_t k = 1; k <= palette.size(); ++k) { // the last entry of the file is unused
      const auto rgba = in.take(4);
      if (rgba.size() == 4 && k < palette.size())
         palette[k] = {static_cast<std::uint8_t>(rgba[0]), static_cast<std::uint8_t>(rgba[1]),
                       static_cast<std::uint8_t>(rgba[2])};
   }
   return palette;
}

std::string materialId(int color) { return fmt::format("{}{}", kMaterialPrefix, color); }

int colorOf(std::string_view materialId)
{
   if (!materialId.starts_with(kMaterialPrefix))
      return 0;
   const auto number = parseInteger(materialId.substr(kMaterialPrefix.size()));
   return number && *number >= 1 && *number <= 255 ? static_cast<int>(*number) : 0;
}

} // namespace diatom::vox
