// One cell: material, orientation, and how it joins into a super-cell. 32 bits, and 0 is "no cell".
#pragma once

#include <cstdint>

namespace diatom {

/// Number in the model's material palette; 0 = empty.
using MaterialIndex = std::uint16_t;

struct Cell
{
   MaterialIndex material = 0;
   std::uint8_t orientation = 0; // rotation number of the cell's shape
   std::uint8_t joins = 0;       // super-cells: kJoinsPrevious, kJoinsNext along the site's super-cell step

   static constexpr std::uint8_t kJoinsPrevious = 1, kJoinsNext = 2;

   constexpr bool empty() const { return material == 0; }
   constexpr std::uint32_t packed() const
   {
      return std::uint32_t{material} | (std::uint32_t{orientation} << 16) | (std::uint32_t{joins} << 24);
   }
   static constexpr Cell unpacked(std::uint32_t bits)
   {
      return {static_cast<MaterialIndex>(bits), static_cast<std::uint8_t>(bits >> 16),
              static_cast<std::uint8_t>(bits >> 24)};
   }
   friend constexpr bool operator==(const Cell &, const Cell &) = default;
};

} // namespace diatom
