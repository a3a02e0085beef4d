// Integer addresses of cells, and inclusive boxes of them.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <limits>

namespace diatom {

/// Address of a cell in a lattice: 32-bit signed per axis.
struct Index
{
   std::int32_t x = 0, y = 0, z = 0;

   friend constexpr bool operator==(const Index &, const Index &) = default;
   friend constexpr auto operator<=>(const Index &, const Index &) = default;
   friend constexpr Index operator+(Index a, Index b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
   friend constexpr Index operator-(Index a, Index b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
   friend constexpr Index operator*(Index a, std::int32_t k) { return {a.x * k, a.y * k, a.z * k}; }
};

/// Largest absolute coordinate a cell may have. The margin to 2^31 keeps sums of two indices from
/// overflowing.
inline constexpr std::int32_t kIndexLimit = (1 << 30) - 1;

/// True when every coordinate is within +-kIndexLimit.
constexpr bool inRange(Index i)
{
   const auto fits = [](std::int32_t v) { return v >= -kIndexLimit && v <= kIndexLimit; };
   return fits(i.x) && fits(i.y) && fits(i.z);
}

/// Inclusive box of indices. Default: empty.
struct Box
{
   Index min{std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::max(),
             std::numeric_limits<std::int32_t>::max()};
   Index max{std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::min(),
             std::numeric_limits<std::int32_t>::min()};

   friend constexpr bool operator==(const Box &, const Box &) = default;

   constexpr bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
   constexpr bool contains(Index i) const
   {
      return i.x >= min.x && i.x <= max.x && i.y >= min.y && i.y <= max.y && i.z >= min.z && i.z <= max.z;
   }
   constexpr bool intersects(const Box &o) const
   {
      return !empty() && !o.empty() && min.x <= o.max.x && max.x >= o.min.x && min.y <= o.max.y &&
             max.y >= o.min.y && min.z <= o.max.z && max.z >= o.min.z;
   }
   constexpr void extend(Index i)
   {
      min = {std::min(min.x, i.x), std::min(min.y, i.y), std::min(min.z, i.z)};
      max = {std::max(max.x, i.x), std::max(max.y, i.y), std::max(max.z, i.z)};
   }
   constexpr void extend(const Box &o)
   {
      if (!o.empty()) {
         extend(o.min);
         extend(o.max);
      }
   }
   /// Cells in the box; saturates nowhere below 2^93, hence the floating type.
   constexpr double volume() const
   {
      return empty()
                 ? 0.0
                 : (double(max.x) - min.x + 1) * (double(max.y) - min.y + 1) * (double(max.z) - min.z + 1);
   }
};

/// Floor modulo: result in [0, m).
constexpr std::int32_t floorMod(std::int32_t a, std::int32_t m)
{
   const std::int32_t r = a % m;
   return r < 0 ? r + m : r;
}

/// Floor division.
constexpr std::int32_t floorDiv(std::int32_t a, std::int32_t m) { return (a - floorMod(a, m)) / m; }

} // namespace diatom
