// From the record a plugin hands over to a Lattice: check, scale, find rotations.
#pragma once

#include "lattice/lattice.h"

#include <diatom/abi/lattice.h>

#include <memory>
#include <optional>
#include <utility>

namespace diatom {

/// The only maker of lattices.
class LatticeBuilder
{
public:
   /// Checks and copies everything; the motif is not needed afterwards.
   static Result<std::shared_ptr<const Lattice>> fromMotif(const LatticeSpec &spec,
                                                           const diatom_motif &motif);

private:
   explicit LatticeBuilder(Lattice &lattice) : m_(lattice) {}

   void addSites(const diatom_motif &motif);
   void addShapes(const diatom_motif &motif, const std::vector<Shape> &shapes);
   void addLinks(const diatom_motif &motif);
   bool addSearch();      // false: too oblique to search
   bool addRotations();   // false: products are missing
   bool addComposition(); // likewise
   std::optional<std::array<std::int32_t, 9>> indexRotation(const Mat3 &rotation) const;

   Index indexOf(int site) const;
   std::optional<Index> cellAt(const Vec3 &point) const;
   std::optional<int> rotationNumber(const Shape &shape, const Mat3 &rotation) const;
   /// What the map x -> rotation x + shift does to the cell of a site: number of the rotation, in the cell's
   /// own frame, by which it lands on a cell of the same shape, links and super-cell; nothing when it does
   /// not.
   std::optional<int> landing(const Mat3 &rotation, const Vec3 &shift, int site) const;
   bool sameLinks(const Mat3 &rotation, const Vec3 &shift, Index from, Index onto) const;
   bool keepsPeriods(const Mat3 &rotation) const;
   /// landing() of every site; empty unless all land.
   std::vector<int> landings(const Mat3 &rotation, int originSite) const;

   Lattice &m_;
   double m_tolerance = 0; // metres
};

/// The rotation matrix, with entries that are multiples of 1/2 made exact, so that turned cells meet without
/// a gap.
Mat3 exactMatrix(const Quat &rotation);

} // namespace diatom
