// Numbers points by their exact doubles, in the order they come.
#pragma once

#include "core/vec.h"

#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace diatom {

class PointNumbers
{
public:
   /// The point's place in `points`, to which a new one is added.
   std::uint32_t number(const Vec3 &point, std::vector<Vec3> &points)
   {
      // 0 and -0 are one place.
      const std::array<double, 3> key{point.x() + 0.0, point.y() + 0.0, point.z() + 0.0};
      const auto [found, added] = m_numbers.emplace(key, static_cast<std::uint32_t>(points.size()));
      if (added)
         points.push_back(point);
      return found->second;
   }
   void clear() { m_numbers.clear(); }

private:
   struct Hash
   {
      std::size_t operator()(const std::array<double, 3> &point) const
      {
         std::uint64_t hash = 0;
         for (const double number : point) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(number)) * 0x9e37'79b9'7f4a'7c15u;
            hash ^= hash >> 29;
         }
         return hash;
      }
   };
   std::unordered_map<std::array<double, 3>, std::uint32_t, Hash> m_numbers;
};

} // namespace diatom
