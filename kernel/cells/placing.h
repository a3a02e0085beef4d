// How placements move boxes of indices, and how large cells are in index space. Internal to kernel/cells.
#pragma once

#include "cells/cell.h"
#include "cells/instances.h"
#include "core/vec.h"
#include "lattice/lattice.h"

#include <memory>
#include <vector>

namespace diatom::detail {

/// n . x <= distance, relative to the cell's centre, metres.
struct Plane
{
   Vec3 normal;
   double distance = 0;
};

inline Vec3 vec(Index i) { return {double(i.x), double(i.y), double(i.z)}; }

/// What the hierarchy derives from a lattice once. Immutable; any thread.
///
/// With basis B, site offsets f and rotation R a placement (o, R) takes index l to w, where
///    B w + f[w] = B o + f[o] + R (B l + f[l] - f[0]),  hence
///    w = o + M l + B^-1 (f[o] - f[w] + R (f[l] - f[0])),  M = B^-1 R B:
/// linear but for a term that depends on sites only, whose range per axis is known. That bounds boxes without
/// a margin by guess.
class Placing
{
public:
   explicit Placing(std::shared_ptr<const Lattice> lattice);

   const Lattice &lattice() const { return *m_lattice; }
   const std::shared_ptr<const Lattice> &shared() const { return m_lattice; }
   bool known(const Placement &p) const { return p.rotation < m_turns.size() && inRange(p.origin); }
   /// The placement only adds its origin.
   bool isShift(const Placement &p) const
   {
      const auto period = m_lattice->period();
      return p.rotation == 0 &&
             (m_lattice->sites() == 1 ||
              (p.origin.x % period[0] == 0 && p.origin.y % period[1] == 0 && p.origin.z % period[2] == 0));
   }
   Index place(const Placement &p, Index local) const
   {
      return isShift(p) ? p.origin + local : m_lattice->place(p.origin, p.rotation, local);
   }
   Index unplace(const Placement &p, Index world) const
   {
      return isShift(p) ? world - p.origin : m_lattice->unplace(p.origin, p.rotation, world);
   }
   /// A box that holds every cell of `local` after placing; tight when isTight().
   Box placeBox(const Placement &p, const Box &local) const;
   /// A box that holds every local cell that may land in `world`.
   Box unplaceBox(const Placement &p, const Box &world) const;
   /// Boxes go to boxes exactly: axes to axes, and every site alike.
   bool isTight(const Placement &p) const { return isShift(p) || m_turns[p.rotation].tight; }
   /// Inner placed within outer as one placement; only when the lattice allows both.
   bool merge(const Placement &outer, const Placement &inner, Placement &merged) const;
   /// The cell as it is after placing: orientation and join flags.
   Cell turned(const Placement &p, Index local, Cell cell) const;

   const Mat3 &inverse() const { return m_inverse; }
   /// Cell i fills no more than i + [low, high] in index space, whatever its site.
   const Vec3 &low() const { return m_low; }
   const Vec3 &high() const { return m_high; }
   /// Cells that may reach into the unit box around index k: k plus these.
   const std::vector<Index> &reach() const { return m_reach; }
   const std::vector<Plane> &planes(int site) const { return m_planes[static_cast<std::size_t>(site)]; }
   double volume(int site) const { return m_lattice->shape(site).volume; }
   /// Sum of position - position of index 0 over n cells of a site, from the sum of their indices.
   Vec3 displacement(int site, double n, const Vec3 &indexSum) const
   {
      return m_basis * indexSum + n * (m_offset[static_cast<std::size_t>(site)] - m_offset[0]);
   }

private:
   struct Turn
   {
      Mat3 forward, backward; // M and its inverse
      Vec3 low, high;         // range of B^-1 (R (f[l] - f[0]) - f[w])
      bool tight = false;
   };
   void measureCells();
   void measureTurns();

   std::shared_ptr<const Lattice> m_lattice;
   Mat3 m_basis, m_inverse;
   std::vector<Vec3> m_shift; // B^-1 f per site
   std::vector<Vec3> m_offset;
   std::vector<Turn> m_turns;
   Vec3 m_low, m_high;
   std::vector<Index> m_reach;
   std::vector<std::vector<Plane>> m_planes;
};

} // namespace diatom::detail
