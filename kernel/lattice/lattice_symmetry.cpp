// Which rotations a composite may be instanced with: part of LatticeBuilder.
#include "lattice/lattice_builder.h"

#include <algorithm>
#include <cmath>

namespace diatom {

namespace {

bool sameRotation(const Mat3 &a, const Mat3 &b) { return (a - b).norm() < 1e-6; }

Quat withPositiveScalar(const Quat &q) { return q.w() < 0 ? Quat(-q.w(), -q.x(), -q.y(), -q.z()) : q; }

} // namespace

Index LatticeBuilder::indexOf(int site) const
{
   const auto &p = m_.m_period;
   return {site / (p[1] * p[2]), site / p[2] % p[1], site % p[2]};
}

std::optional<Index> LatticeBuilder::cellAt(const Vec3 &point) const
{
   const Index cell = m_.nearest(point);
   if ((m_.position(cell) - point).norm() > m_tolerance)
      return std::nullopt;
   return cell;
}

std::optional<int> LatticeBuilder::rotationNumber(const Shape &shape, const Mat3 &rotation) const
{
   for (std::size_t n = 0; n < shape.rotations.size(); ++n)
      if (sameRotation(exactMatrix(shape.rotations[n]), rotation))
         return static_cast<int>(n);
   return std::nullopt;
}

bool LatticeBuilder::sameLinks(const Mat3 &rotation, const Vec3 &shift, Index from, Index onto) const
{
   const auto mine = m_.links(m_.site(from)), theirs = m_.links(m_.site(onto));
   return mine.size() == theirs.size() && std::all_of(mine.begin(), mine.end(), [&](const Link &link) {
             const auto neighbour = cellAt(rotation * m_.position(from + link.offset) + shift);
             return neighbour && std::any_of(theirs.begin(), theirs.end(), [&](const Link &other) {
                       return other.offset == *neighbour - onto && other.contact == link.contact &&
                              other.joined == link.joined;
                    });
          });
}

std::optional<int> LatticeBuilder::landing(const Mat3 &rotation, const Vec3 &shift, int site) const
{
   const Index from = indexOf(site);
   const auto onto = cellAt(rotation * m_.position(from) + shift);
   if (!onto)
      return std::nullopt;
   const int target = m_.site(*onto);
   if (m_.m_shapeOf[static_cast<std::size_t>(site)] != m_.m_shapeOf[static_cast<std::size_t>(target)])
      return std::nullopt;
   if (m_.hasSupercells()) {
      const Vec3 turned = rotation * (m_.position(from + m_.supercellStep(site)) - m_.position(from));
      const Vec3 own = m_.position(*onto + m_.supercellStep(target)) - m_.position(*onto);
      if ((turned - own).norm() > m_tolerance && (turned + own).norm() > m_tolerance)
         return std::nullopt;
   }
   if (!sameLinks(rotation, shift, from, *onto))
      return std::nullopt;
   return rotationNumber(m_.shape(site), exactMatrix(m_.orientation(target)).transpose() * rotation *
                                             exactMatrix(m_.orientation(site)));
}

// One cell per site stands for all only if a turned period leads from like to like, unturned.
bool LatticeBuilder::keepsPeriods(const Mat3 &rotation) const
{
   for (int k = 0; k < 3; ++k) {
      const Vec3 period = rotation * m_.m_basis.col(k) * m_.m_period[static_cast<std::size_t>(k)];
      for (int site = 0; site < m_.sites(); ++site)
         if (landing(Mat3::Identity(), period, site) != 0)
            return false;
   }
   return true;
}

std::vector<int> LatticeBuilder::landings(const Mat3 &rotation, int originSite) const
{
   const Vec3 shift = m_.position(indexOf(originSite)) - rotation * m_.position(Index{});
   std::vector<int> turns;
   for (int site = 0; site < m_.sites(); ++site) {
      const auto turn = landing(rotation, shift, site);
      if (!turn)
         return {};
      turns.push_back(*turn);
   }
   return turns;
}

bool LatticeBuilder::addRotations()
{
   for (const Shape &shape : m_.m_shapes) {
      std::vector<int> products;
      for (const Quat &a : shape.rotations)
         for (const Quat &b : shape.rotations) {
            const auto product = rotationNumber(shape, exactMatrix(a * b));
            if (!product)
               return false;
            products.push_back(*product);
         }
      m_.m_shapeCompose.push_back(std::move(products));
   }

   const Quat first = m_.orientation(0);
   for (int site = 0; site < m_.sites(); ++site) {
      if (m_.m_shapeOf[static_cast<std::size_t>(site)] != m_.m_shapeOf[0])
         continue;
      for (const Quat &own : m_.shape(0).rotations) {
         const Quat world = withPositiveScalar((m_.orientation(site) * own * first.conjugate()).normalized());
         const Mat3 matrix = exactMatrix(world);
         const auto known = [&](const Mat3 &other) { return sameRotation(matrix, other); };
         if (std::any_of(m_.m_rotationMatrix.begin(), m_.m_rotationMatrix.end(), known) ||
             !keepsPeriods(matrix))
            continue;
         std::vector<std::vector<int>> turns;
         for (int origin = 0; origin < m_.sites(); ++origin)
            turns.push_back(landings(matrix, origin));
         const auto allowed =
             std::find_if(turns.begin(), turns.end(), [](const auto &t) { return !t.empty(); });
         if (allowed == turns.end())
            continue;
         m_.m_firstAllowed.push_back(static_cast<int>(allowed - turns.begin()));
         m_.m_turn.insert(m_.m_turn.end(), turns.begin(), turns.end());
         m_.m_rotations.push_back(world);
         m_.m_rotationMatrix.push_back(matrix);
         m_.m_indexRotation.push_back(indexRotation(matrix));
      }
   }
   return true;
}

// A rotation about a site maps indices by an integer matrix when sites are the points of one plain lattice.
std::optional<std::array<std::int32_t, 9>> LatticeBuilder::indexRotation(const Mat3 &rotation) const
{
   for (const Vec3 &offset : m_.m_offset)
      if ((offset - m_.m_offset.front()).norm() > m_tolerance)
         return std::nullopt;
   const Mat3 steps = m_.m_inverse * rotation * m_.m_basis;
   std::array<std::int32_t, 9> matrix{};
   for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) {
         const double whole = std::round(steps(row, column));
         if (std::abs(steps(row, column) - whole) > 1e-6 || std::abs(whole) > 4)
            return std::nullopt;
         matrix[3 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)] =
             static_cast<std::int32_t>(whole);
      }
   return matrix;
}

// Maps of the lattice onto itself that take like to like form a group, so every product is in the list.
bool LatticeBuilder::addComposition()
{
   const auto count = m_.m_rotationMatrix.size();
   m_.m_inverseOf.assign(count, 0);
   for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = 0; b < count; ++b) {
         const Mat3 product = m_.m_rotationMatrix[a] * m_.m_rotationMatrix[b];
         const auto found = std::find_if(m_.m_rotationMatrix.begin(), m_.m_rotationMatrix.end(),
                                         [&](const Mat3 &other) { return sameRotation(product, other); });
         if (found == m_.m_rotationMatrix.end())
            return false;
         const auto number = static_cast<int>(found - m_.m_rotationMatrix.begin());
         m_.m_compose.push_back(number);
         if (number == 0)
            m_.m_inverseOf[a] = static_cast<int>(b);
      }
   return true;
}

} // namespace diatom
