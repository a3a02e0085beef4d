#include "render/lines.h"

#include <algorithm>
#include <utility>

namespace diatom::render {

void addLoop(std::vector<Line> &lines, std::span<const Vec3> corners, Rgba color, float width)
{
   for (std::size_t i = 0; i < corners.size(); ++i)
      lines.push_back({corners[i], corners[(i + 1) % corners.size()], color, width});
}

void addHatch(std::vector<Line> &lines, std::span<const Vec3> corners, double spacing, Rgba color,
              float width)
{
   if (corners.size() < 3 || !(spacing > 0))
      return;
   const Vec3 along = (corners[1] - corners[0] + 0.6 * (corners[2] - corners[1])).normalized();
   const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[1]).normalized();
   const Vec3 across = normal.cross(along);
   double low = 1e300, high = -1e300;
   for (const Vec3 &c : corners) {
      low = std::min(low, across.dot(c));
      high = std::max(high, across.dot(c));
   }
   for (int line = 0; low + (line + 0.5) * spacing < high; ++line) {
      const double at = low + (line + 0.5) * spacing;
      std::vector<Vec3> cut;
      for (std::size_t i = 0; i < corners.size(); ++i) {
         const Vec3 &p = corners[i], &q = corners[(i + 1) % corners.size()];
         const double dp = across.dot(p) - at, dq = across.dot(q) - at;
         if ((dp < 0) != (dq < 0))
            cut.push_back(p + (q - p) * (dp / (dp - dq)));
      }
      if (cut.size() == 2)
         lines.push_back({cut[0], cut[1], color, width});
   }
}

void addBox(std::vector<Line> &lines, const Vec3 &low, const Vec3 &high, Rgba color, float width)
{
   const auto corner = [&](int i) {
      return Vec3(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
   };
   for (int i = 0; i < 8; ++i)
      for (const int bit : {1, 2, 4})
         if (!(i & bit))
            lines.push_back({corner(i), corner(i | bit), color, width});
}

namespace {

/// Strokes on a grid 4 wide and 8 high, y down, base line at 6: pairs of digits "xy" joined to a path, paths
/// separated by a blank.
const char *strokes(char c)
{
   static constexpr std::pair<char, const char *> font[] = {
       {'0', "0110 1030 3041 4145 4536 3616 1605 0501"},
       {'1', "0121 2026 1036"},
       {'2', "0110 1030 3041 4142 4206 0646"},
       {'3', "0040 4022 2232 3243 4345 4536 3616 1605"},
       {'4', "3036 3004 0444"},
       {'5', "4000 0002 0232 3243 4345 4536 3606"},
       {'6', "3010 1001 0105 0516 1636 3645 4544 4433 3303"},
       {'7', "0040 4016"},
       {'8', "1030 3041 4142 4233 3313 1302 0201 0110 1304 0405 0516 1636 3645 4544 4433"},
       {'9', "4313 1302 0201 0110 1030 3041 4145 4536 3616"},
       {'.', "1516 1626 2625 2515"},
       {'-', "0343"},
       {'=', "0242 0444"},
       {'(', "3021 2125 2536"},
       {')', "1021 2125 2516"},
       {'a', "0212 1232 3243 4346 4416 1605 0504 0413 1344"},
       {'c', "4222 2212 1203 0305 0516 1646"},
       {'d', "4046 4212 1203 0305 0516 1646"},
       {'e', "0444 4443 4332 3212 1203 0305 0516 1646"},
       {'i', "2226 2021"},
       {'l', "2025 2536"},
       {'m', "0206 0212 1223 2326 2332 3243 4346"},
       {'n', "0206 0232 3243 4346"},
       {'p', "0208 0232 3243 4345 4536 3606"},
       {'r', "0206 0422 2242"},
       {'s', "4212 1203 0314 1434 3445 4536 3606"},
       {'t', "1015 1526 2636 0242"},
       {'u', "0205 0516 1646 4246"},
       {'X', "0046 4006"},
       {'Y', "0023 4023 2326"},
       {'Z', "0040 4006 0646"}};
   for (const auto &[character, paths] : font)
      if (character == c)
         return paths;
   return "";
}

constexpr double kAdvance = 5.6 / 6; // of the height of a digit

} // namespace

void addText(std::vector<Line> &lines, std::string_view text, const Eigen::Vector2d &at, double size,
             Rgba color, float width)
{
   double left = at.x();
   for (const char c : text) {
      for (std::string_view path = strokes(c); path.size() >= 4;
           path.remove_prefix(std::min<std::size_t>(5, path.size())))
      {
         const auto point = [&](std::size_t i) {
            return Vec3(left + (path[i] - '0') * size / 6, at.y() + (path[i + 1] - '0') * size / 6, 0);
         };
         lines.push_back({point(0), point(2), color, width});
      }
      left += kAdvance * size;
   }
}

double textWidth(std::string_view text, double size) { return kAdvance * size * double(text.size()); }

} // namespace diatom::render
