#include "explicit/box_columns.h"

#include <cmath>

namespace bonds {

std::array<double, kBoxColumns> boxColumns(const Assembly &assembly, std::int64_t cell)
{
   constexpr double kAlike = 1e-12;
   double own[3];
   for (std::size_t k = 0; k < 3; ++k)
      own[k] = assembly.boxInertia[k][cell];
   const auto apart = [&](int k) { return std::abs(own[(k + 1) % 3] - own[(k + 2) % 3]); };
   const int first = apart(0) <= apart(1) ? (apart(0) <= apart(2) ? 0 : 2) : (apart(1) <= apart(2) ? 1 : 2);
   const int second = (first + 1) % 3, ball = (first + 2) % 3;
   const Mat3 frame = matrix(assembly.orientation[cell]);
   std::array<double, kBoxColumns> out{own[ball], 1 / own[ball]};
   const auto about = [&](std::size_t column, int k) {
      const Vec3 axis = frame * Vec3{k == 0 ? 1.0 : 0, k == 1 ? 1.0 : 0, k == 2 ? 1.0 : 0};
      out[column] = axis.x;
      out[column + 1] = axis.y;
      out[column + 2] = axis.z;
      out[column + 3] = own[k] - own[ball];
      out[column + 4] = 1 / own[k] - 1 / own[ball];
   };
   about(kFirstAxis, first);
   if (apart(first) > kAlike * own[ball])
      about(kSecondAxis, second);
   return out;
}

} // namespace bonds
