// Numbers of things by where they are, to find those near a place.
#pragma once

#include "core/vec.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace diatom {

class PlaceGrid
{
public:
   /// near() finds all that lie within `size` of the place, and some farther away.
   explicit PlaceGrid(double size) : m_size(size) {}

   void add(const Vec3 &place, std::uint32_t number) { m_cells[cellOf(place)].push_back(number); }

   template<typename Visit>
   void near(const Vec3 &place, const Visit &visit) const
   {
      const Cell cell = cellOf(place);
      for (int k = 0; k < 27; ++k) {
         const auto found = m_cells.find({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
         if (found != m_cells.end())
            for (const std::uint32_t number : found->second)
               visit(number);
      }
   }

private:
   using Cell = std::array<long long, 3>;
   struct Hash
   {
      std::size_t operator()(const Cell &cell) const
      {
         std::uint64_t hash = 0;
         for (const long long k : cell) {
            hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9e37'79b9'7f4a'7c15u;
            hash ^= hash >> 31;
         }
         return hash;
      }
   };
   Cell cellOf(const Vec3 &place) const
   {
      return {std::llround(place.x() / m_size), std::llround(place.y() / m_size),
              std::llround(place.z() / m_size)};
   }

   double m_size;
   std::unordered_map<Cell, std::vector<std::uint32_t>, Hash> m_cells;
};

} // namespace diatom
