// Boxes through placements; sizes of cells in index space.
#include "cells/placing.h"

#include <algorithm>
#include <cmath>

namespace diatom::detail {

namespace {

Index siteIndex(int site, const std::array<int, 3> &period)
{
   return {site / (period[1] * period[2]), site / period[2] % period[1], site % period[2]};
}

/// Integers within [low, high], allowing for rounding of doubles, kept where boxes can be shifted without
/// overflow.
Box integersWithin(const Vec3 &low, const Vec3 &high)
{
   constexpr double kLimit = 2147483000.0;
   const auto slack = [](double v) { return 1e-6 + 1e-12 * std::abs(v); };
   const auto down = [&](double v) {
      return static_cast<std::int32_t>(std::clamp(std::ceil(v - slack(v)), -kLimit, kLimit));
   };
   const auto up = [&](double v) {
      return static_cast<std::int32_t>(std::clamp(std::floor(v + slack(v)), -kLimit, kLimit));
   };
   return {{down(low.x()), down(low.y()), down(low.z())}, {up(high.x()), up(high.y()), up(high.z())}};
}

/// Range of matrix times the box [low, high].
void transformRange(const Mat3 &matrix, Vec3 &low, Vec3 &high)
{
   const Vec3 middle = matrix * (0.5 * (low + high));
   const Vec3 half = matrix.cwiseAbs() * (0.5 * (high - low));
   low = middle - half;
   high = middle + half;
}

// What nearest() may be off by where a placement puts cells beside the lattice's sites.
constexpr double kStray = 2;

} // namespace

Placing::Placing(std::shared_ptr<const Lattice> lattice) : m_lattice(std::move(lattice))
{
   const auto period = m_lattice->period();
   const Vec3 zero = m_lattice->position({});
   const Index steps[3] = {{period[0], 0, 0}, {0, period[1], 0}, {0, 0, period[2]}};
   for (int a = 0; a < 3; ++a)
      m_basis.col(a) = (m_lattice->position(steps[a]) - zero) / period[static_cast<std::size_t>(a)];
   m_inverse = m_basis.inverse();
   for (int s = 0; s < m_lattice->sites(); ++s) {
      const Index i = siteIndex(s, period);
      m_offset.push_back(m_lattice->position(i) - m_basis * vec(i));
      m_shift.push_back(m_inverse * m_offset.back());
   }
   measureCells();
   measureTurns();
}

void Placing::measureCells()
{
   m_low = Vec3::Constant(1e300);
   m_high = -m_low;
   for (int s = 0; s < m_lattice->sites(); ++s) {
      const auto corners = m_lattice->corners(s);
      for (const Vec3 &corner : corners) {
         const Vec3 at = m_shift[static_cast<std::size_t>(s)] + m_inverse * corner;
         m_low = m_low.cwiseMin(at);
         m_high = m_high.cwiseMax(at);
      }
      auto &planes = m_planes.emplace_back();
      for (const auto &face : m_lattice->shape(s).faces) {
         Vec3 normal = Vec3::Zero(); // Newell's method: exact for any planar polygon
         for (std::size_t k = 0; k < face.size(); ++k)
            normal += corners[static_cast<std::size_t>(face[k])].cross(
                corners[static_cast<std::size_t>(face[(k + 1) % face.size()])]);
         normal.normalize();
         planes.push_back({normal, normal.dot(corners[static_cast<std::size_t>(face[0])])});
      }
   }
   // Cell k + d meets the unit box around k when its extent and [-1/2, 1/2] overlap by more than rounding.
   constexpr double kTouch = 0.5 - 1e-9;
   Index from, to;
   const auto range = [&](int a, std::int32_t &low, std::int32_t &high) {
      low = static_cast<std::int32_t>(std::ceil(-kTouch - m_high[a]));
      high = static_cast<std::int32_t>(std::floor(kTouch - m_low[a]));
   };
   range(0, from.x, to.x);
   range(1, from.y, to.y);
   range(2, from.z, to.z);
   for (std::int32_t x = from.x; x <= to.x; ++x)
      for (std::int32_t y = from.y; y <= to.y; ++y)
         for (std::int32_t z = from.z; z <= to.z; ++z)
            m_reach.push_back({x, y, z});
}

void Placing::measureTurns()
{
   for (const Quat &rotation : m_lattice->rotations()) {
      const Mat3 r = rotation.toRotationMatrix();
      Turn turn;
      turn.forward = m_inverse * r * m_basis;
      turn.backward = m_inverse * r.transpose() * m_basis;
      Vec3 low = Vec3::Constant(1e300), high = -low, landedLow = low, landedHigh = high;
      for (std::size_t s = 0; s < m_offset.size(); ++s) {
         const Vec3 moved = m_inverse * (r * (m_offset[s] - m_offset[0]));
         low = low.cwiseMin(moved);
         high = high.cwiseMax(moved);
         landedLow = landedLow.cwiseMin(m_shift[s]);
         landedHigh = landedHigh.cwiseMax(m_shift[s]);
      }
      turn.low = low - landedHigh;
      turn.high = high - landedLow;
      const Mat3 size = turn.forward.cwiseAbs();
      const bool axesToAxes = (size.rowwise().maxCoeff().array() - 1).abs().maxCoeff() < 1e-9 &&
                              (size.rowwise().sum().array() - 1).abs().maxCoeff() < 1e-9;
      turn.tight = axesToAxes && (turn.high - turn.low).maxCoeff() < 1e-9;
      m_turns.push_back(turn);
   }
}

Box Placing::placeBox(const Placement &p, const Box &local) const
{
   if (local.empty())
      return local;
   if (isShift(p))
      return {local.min + p.origin, local.max + p.origin};
   const Turn &turn = m_turns[p.rotation];
   Vec3 low = vec(local.min), high = vec(local.max);
   transformRange(turn.forward, low, high);
   const Vec3 origin = vec(p.origin) + m_shift[static_cast<std::size_t>(m_lattice->site(p.origin))];
   const Vec3 stray = Vec3::Constant(m_lattice->placementAllowed(p.origin, p.rotation) ? 0 : kStray);
   return integersWithin(low + origin + turn.low - stray, high + origin + turn.high + stray);
}

Box Placing::unplaceBox(const Placement &p, const Box &world) const
{
   if (world.empty())
      return world;
   const Turn &turn = m_turns[p.rotation];
   const Vec3 origin = vec(p.origin) + m_shift[static_cast<std::size_t>(m_lattice->site(p.origin))];
   const Vec3 stray = Vec3::Constant(m_lattice->placementAllowed(p.origin, p.rotation) ? 0 : kStray);
   Vec3 low = vec(world.min) - origin - turn.high - stray, high = vec(world.max) - origin - turn.low + stray;
   transformRange(turn.backward, low, high);
   return integersWithin(low, high);
}

bool Placing::merge(const Placement &outer, const Placement &inner, Placement &merged) const
{
   if (!m_lattice->placementAllowed(outer.origin, outer.rotation) ||
       !m_lattice->placementAllowed(inner.origin, inner.rotation))
      return false;
   merged = {inner.definition, place(outer, inner.origin),
             static_cast<std::uint8_t>(m_lattice->compose(outer.rotation, inner.rotation))};
   return inRange(merged.origin);
}

Cell Placing::turned(const Placement &p, Index local, Cell cell) const
{
   const int site = m_lattice->site(local);
   if (!isShift(p) && cell.orientation < m_lattice->shape(site).rotations.size())
      cell.orientation = static_cast<std::uint8_t>(
          m_lattice->turnedOrientation(p.origin, local, p.rotation, cell.orientation));
   const bool oneSided = cell.joins == Cell::kJoinsPrevious || cell.joins == Cell::kJoinsNext;
   if (!oneSided || !m_lattice->hasSupercells() || isShift(p))
      return cell;
   const Index world = place(p, local);
   const auto step = [&](Index i) -> Vec3 {
      return m_lattice->position(i + m_lattice->supercellStep(m_lattice->site(i))) - m_lattice->position(i);
   };
   // "Next" is along the step of the site where the cell lies: turned half way round, next becomes previous.
   const Vec3 direction = m_lattice->rotations()[p.rotation] * step(local);
   if (direction.dot(step(world)) < 0)
      cell.joins = cell.joins == Cell::kJoinsPrevious ? Cell::kJoinsNext : Cell::kJoinsPrevious;
   return cell;
}

} // namespace diatom::detail
