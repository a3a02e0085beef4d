// What the surface needs to know of a lattice, per site: what lies across each face, and for every corner the
// one cell that speaks for it.
#pragma once

#include "lattice/lattice.h"

#include <vector>

namespace diatom {

/// A corner in the words of its owner: of all cells that share the point, the one with the smallest index.
/// All sharers name the same owner and the same vertex of it, so that they compute the very same doubles.
struct CornerOwner
{
   Index offset; // owner minus cell
   int vertex = 0;
};

struct FaceTable
{
   bool linked = false; // some cell can lie across
   Index across;        // neighbour minus cell
   std::vector<CornerOwner> corners;
};

class SurfaceTables
{
public:
   explicit SurfaceTables(const Lattice &lattice);

   const std::vector<FaceTable> &faces(int site) const { return m_faces[static_cast<std::size_t>(site)]; }
   const std::vector<CornerOwner> &corners(int site) const
   {
      return m_owners[static_cast<std::size_t>(site)];
   }
   /// How far `across` reaches along any axis.
   int halo() const { return m_halo; }
   /// Whether some cell can lie across every face: only then cells can be wholly covered.
   bool allLinked() const { return m_allLinked; }
   Vec3 corner(Index cell, const CornerOwner &owner) const;

private:
   CornerOwner ownerOf(int site, Index representative, int vertex) const;

   const Lattice &m_lattice;
   std::vector<std::vector<FaceTable>> m_faces;
   std::vector<std::vector<CornerOwner>> m_owners; // per site and vertex of the shape
   int m_halo = 0;
   bool m_allLinked = true;
};

} // namespace diatom
